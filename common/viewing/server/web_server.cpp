#include "voxlist/viewing/server/web_server.h"

// Asio 1.74 forgets that it needs this with C++20.
// clang-format off
#include <utility>
// clang-format on

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdlib>
#include <random>
#include <stdexcept>
#include <vector>

#include "voxlist/viewing/server/page_files.h"
#include "voxlist/viewing/server/rules.h"

namespace voxlist::viewing {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

constexpr int kMostClients = 8;
constexpr int kMostConnections = 64;
constexpr std::chrono::seconds kRequestTime(10);
constexpr std::chrono::seconds kIdleTime(30);
constexpr std::uint32_t kMostHeaderBytes = 8192;

// What the kernel holds of what a client has not read: a slow one sees newer content for it.
constexpr int kSendBufferBytes = 256 * 1024;

using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

std::string random_token() {
  std::random_device random;
  std::string token;
  for (int i = 0; i < 32; ++i) token += "0123456789abcdef"[random() % 16];
  return token;
}

std::string_view text(beast::string_view view) { return {view.data(), view.size()}; }

// A header's value; nothing where it is not there.
template <class Name>
std::optional<std::string_view> header(const Request& request, Name name) {
  const auto found = request.find(name);
  if (found == request.end()) return std::nullopt;
  return text(found->value());
}

template <class Name>
bool is_repeated(const Request& request, Name name) {
  const auto [begin, end] = request.equal_range(name);
  return std::distance(begin, end) > 1;
}

constexpr const char* kTokenHeader = "X-Voxlist-Token";

Asked asked_by(const Request& request) {
  using http::field;
  Asked asked{text(request.method_string()),
              text(request.target()),
              header(request, field::host),
              header(request, field::origin),
              header(request, field::content_type),
              header(request, kTokenHeader),
              header(request, field::sec_websocket_protocol)};
  asked.wants_upgrade = websocket::is_upgrade(request) || request.count(field::upgrade) > 0;
  asked.repeats_a_header = is_repeated(request, kTokenHeader);
  for (const field name : {field::host, field::origin, field::content_type, field::upgrade,
                           field::sec_websocket_protocol, field::content_length})
    asked.repeats_a_header |= is_repeated(request, name);
  return asked;
}

Response answer(const Request& request, unsigned status, std::string_view type,
                std::string_view body) {
  Response response(static_cast<http::status>(status), 11);
  using http::field;
  response.set(field::content_type, beast::string_view(type.data(), type.size()));
  response.set(field::cache_control, "no-store");
  response.set("Content-Security-Policy",
               "default-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.keep_alive(request.keep_alive() && status < 400);
  response.body() = body;
  response.prepare_payload();
  if (request.method() == http::verb::head) response.body().clear();
  return response;
}

}  // namespace

bool is_address(const std::string& address) {
  error_code error;
  asio::ip::make_address(address, error);
  return !error;
}

bool is_loopback(const std::string& address) {
  error_code error;
  const auto parsed = asio::ip::make_address(address, error);
  return !error && parsed.is_loopback();
}

int inherited_socket() {
  const char* fds = std::getenv("LISTEN_FDS");
  constexpr int kFirst = 3;
  return fds != nullptr && std::string_view(fds) == "1" ? kFirst : -1;
}

struct WebServer::Impl : std::enable_shared_from_this<WebServer::Impl> {
  class Connection;
  class Stream;
  class LiveStream;
  class ForeignStream;

  explicit Impl(ServerOwner its_owner) : owner(std::move(its_owner)) {
    rules.token = random_token();
    rules.foreign_protocols = owner.foreign.names;
    rules.foreign_origins = owner.foreign.origins;
  }

  void listen(const ServerOptions& options);
  void accept();
  template <class S>
  void open_stream(beast::tcp_stream stream, const Request& request, const std::string& protocol);

  ServerOwner owner;
  Rules rules;
  int connections = 0;
  int clients = 0;
  std::int64_t refused = 0;
  bool is_closing = false;
  std::vector<std::weak_ptr<Stream>> streams;
  // Its end ends connections and streams, which look at what is above.
  asio::io_context io;
  tcp::acceptor acceptor{io};
};

// One client of a WebSocket, whatever is spoken.
class WebServer::Impl::Stream : public std::enable_shared_from_this<Stream> {
 public:
  Stream(beast::tcp_stream stream, Impl& server) : server_(server), socket_(std::move(stream)) {
    ++server_.clients;
  }
  virtual ~Stream() { --server_.clients; }

  void accept(const Request& request, const std::string& protocol) {
    beast::get_lowest_layer(socket_).expires_never();
    socket_.set_option(websocket::stream_base::timeout{kRequestTime, kIdleTime, true});
    socket_.set_option(
        websocket::stream_base::decorator([protocol](websocket::response_type& response) {
          response.set(http::field::sec_websocket_protocol, protocol);
        }));
    socket_.read_message_max(kMostBytes);
    socket_.auto_fragment(false);
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return;
      self->is_open_ = true;
      self->read();
      self->write();
    });
  }

  // Sends what is next, if nothing is on its way.
  void write() {
    if (!is_open_ || is_writing_) return;
    const auto message = next();
    if (!message) return;
    socket_.text(message->is_text);
    is_writing_ = true;
    socket_.async_write(message->buffer,
                        [self = shared_from_this()](error_code error, std::size_t) {
                          self->is_writing_ = false;
                          if (error) return self->end();
                          self->write();
                        });
  }

 protected:
  // What lies in a stream until it has been sent.
  struct Outgoing {
    asio::const_buffer buffer;
    bool is_text;
  };

  virtual std::optional<Outgoing> next() = 0;
  virtual void hear(std::string_view bytes, bool is_text) = 0;

  Impl& server_;

 private:
  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->end();
      const auto bytes = self->buffer_.data();
      self->hear({static_cast<const char*>(bytes.data()), bytes.size()}, self->socket_.got_text());
      self->buffer_.clear();
      self->read();
    });
  }

  void end() {
    is_open_ = false;
    beast::get_lowest_layer(socket_).close();
  }

  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_;
  bool is_open_ = false, is_writing_ = false;
};

// The page. Its number is the owner's.
class WebServer::Impl::LiveStream : public Stream {
 public:
  LiveStream(beast::tcp_stream stream, Impl& server)
      : Stream(std::move(stream), server), number_(server.owner.open()) {}
  ~LiveStream() override {
    if (!server_.is_closing) server_.owner.close(number_);
  }

 private:
  std::optional<Outgoing> next() override {
    auto frame = server_.owner.next(number_);
    if (!frame) return std::nullopt;
    frame_ = std::move(*frame);
    return Outgoing{asio::buffer(frame_), false};
  }

  // What a page says is read for pings and its end, and means nothing.
  void hear(std::string_view, bool) override {}

  const int number_;
  Frame frame_;
};

// Somebody else's viewer.
class WebServer::Impl::ForeignStream : public Stream {
 public:
  ForeignStream(beast::tcp_stream stream, Impl& server)
      : Stream(std::move(stream), server), number_(server.owner.foreign.open()) {}
  ~ForeignStream() override {
    if (!server_.is_closing) server_.owner.foreign.close(number_);
  }

 private:
  std::optional<Outgoing> next() override {
    auto message = server_.owner.foreign.next(number_);
    if (!message) return std::nullopt;
    message_ = std::move(*message);
    return Outgoing{asio::buffer(message_.bytes), message_.is_text};
  }

  void hear(std::string_view bytes, bool is_text) override {
    server_.owner.foreign.hear(number_, bytes, is_text);
    write();
  }

  const int number_;
  SocketMessage message_;
};

// One connection that asks for files, posts commands, or becomes a Stream.
class WebServer::Impl::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, Impl& server) : stream_(std::move(socket)), server_(server) {
    ++server_.connections;
  }
  ~Connection() { --server_.connections; }

  void read() {
    parser_.emplace();
    parser_->header_limit(kMostHeaderBytes);
    parser_->body_limit(kMostBytes);
    stream_.expires_after(kRequestTime);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](error_code error, std::size_t) {
                       if (error) return self->refuse_unread(error);
                       self->answer_request(self->parser_->release());
                     });
  }

 private:
  // What is no request, or too large a one. Who went away is answered nothing.
  void refuse_unread(error_code error) {
    if (error == http::error::end_of_stream || error == beast::error::timeout) return;
    if (error.category() != http::make_error_code(http::error::bad_method).category()) return;
    const bool is_large = error == http::error::body_limit || error == http::error::header_limit;
    write_refusal({}, {Deed::kRefuse, is_large ? 413U : 400U, "no request that is understood"});
  }

  void answer_request(Request request) {
    const Ruling ruling = rule(asked_by(request), server_.rules);
    switch (ruling.deed) {
      case Deed::kFile:
        return write_file(request);
      case Deed::kCommand:
        return write_command(request);
      case Deed::kUpgrade:
        return upgrade<LiveStream>(request, std::string(kLiveProtocol));
      case Deed::kForeignUpgrade:
        return upgrade<ForeignStream>(request, *foreign_protocol(asked_by(request), server_.rules));
      case Deed::kRefuse:
        return write_refusal(request, ruling);
    }
  }

  template <class S>
  void upgrade(const Request& request, const std::string& protocol) {
    if (!websocket::is_upgrade(request))
      return write_refusal(request, {Deed::kRefuse, 400, "no WebSocket handshake"});
    if (server_.clients >= kMostClients)
      return write_refusal(request, {Deed::kRefuse, 503, "too many clients"});
    server_.open_stream<S>(std::move(stream_), request, protocol);
  }

  void write_file(const Request& request) {
    const std::string_view target = text(request.target());
    const PageFile* file = find_page_file(target.substr(0, target.find('?')));
    if (file == nullptr) return write_refusal(request, {Deed::kRefuse, 404, "no such file"});
    write(answer(request, 200, file->type, file->text));
  }

  void write_command(const Request& request) {
    const std::string name(text(request.target()).substr(kCommandPath.size()));
    const CommandAnswer said = server_.owner.command(name, request.body());
    if (said.status >= 400) ++server_.refused;
    write(answer(request, said.status, "text/plain; charset=utf-8", said.sentence));
  }

  void write_refusal(const Request& request, const Ruling& ruling) {
    ++server_.refused;
    write(answer(request, ruling.status, "text/plain; charset=utf-8", ruling.why));
  }

  void write(Response response) {
    response_.emplace(std::move(response));
    http::async_write(stream_, *response_,
                      [self = shared_from_this()](error_code error, std::size_t) {
                        if (error) return;
                        if (self->response_->keep_alive()) return self->read();
                        error_code ignored;
                        self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                      });
  }

  beast::tcp_stream stream_;
  Impl& server_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  std::optional<Response> response_;
};

void WebServer::Impl::listen(const ServerOptions& options) try {
  if (options.listening_fd >= 0) {
    acceptor.assign(tcp::v4(), options.listening_fd);
  } else {
    const tcp::endpoint endpoint(asio::ip::make_address(options.address), options.port);
    acceptor.open(endpoint.protocol());
    acceptor.set_option(asio::socket_base::reuse_address(true));
    acceptor.bind(endpoint);
    acceptor.listen();
  }
  rules.port = acceptor.local_endpoint().port();
  rules.is_open = !acceptor.local_endpoint().address().is_loopback();
  accept();
} catch (const std::exception& error) {
  throw std::runtime_error("cannot serve the page on " + options.address + ":" +
                           std::to_string(options.port) + ": " + error.what());
}

void WebServer::Impl::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error && connections + clients < kMostConnections) {
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      socket.set_option(asio::socket_base::send_buffer_size(kSendBufferBytes), ignored);
      std::make_shared<Connection>(std::move(socket), *this)->read();
    }
    accept();
  });
}

template <class S>
void WebServer::Impl::open_stream(beast::tcp_stream stream, const Request& request,
                                  const std::string& protocol) {
  const std::shared_ptr<Stream> fresh = std::make_shared<S>(std::move(stream), *this);
  std::erase_if(streams, [](const auto& gone) { return gone.expired(); });
  streams.push_back(fresh);
  fresh->accept(request, protocol);
}

WebServer::WebServer(const ServerOptions& options, ServerOwner owner)
    : impl_(std::make_shared<Impl>(std::move(owner))) {
  impl_->listen(options);
}

WebServer::~WebServer() { impl_->is_closing = true; }

void WebServer::poll() {
  for (const auto& stream : impl_->streams)
    if (const auto open = stream.lock()) open->write();
  impl_->io.restart();
  impl_->io.poll();
}

std::uint16_t WebServer::port() const { return impl_->rules.port; }
int WebServer::clients() const { return impl_->clients; }
std::int64_t WebServer::refused() const { return impl_->refused; }
const std::string& WebServer::token() const { return impl_->rules.token; }

}  // namespace voxlist::viewing
