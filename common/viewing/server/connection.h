#pragma once

// For web_server.cpp alone (http_messages.h).
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "voxlist/viewing/server/http_messages.h"
#include "voxlist/viewing/server/page_files.h"
#include "voxlist/viewing/server/streams.h"

namespace voxlist::viewing {

/// One connection that asks for files, posts commands, or becomes a Stream.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, ServerState& server)
      : stream_(std::move(socket)), server_(server) {
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
  static constexpr int kMostClients = 8;
  static constexpr std::uint32_t kMostHeaderBytes = 8192;

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
    const std::shared_ptr<Stream> fresh = std::make_shared<S>(std::move(stream_), server_);
    std::erase_if(server_.streams, [](const auto& gone) { return gone.expired(); });
    server_.streams.push_back(fresh);
    fresh->accept(request, protocol);
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
  ServerState& server_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  std::optional<Response> response_;
};

}  // namespace voxlist::viewing
