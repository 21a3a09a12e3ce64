#pragma once

// For web_server.cpp alone (http_messages.h).
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "voxlist/viewing/server/http_messages.h"
#include "voxlist/viewing/server/web_server.h"

namespace voxlist::viewing {

inline constexpr std::chrono::seconds kRequestTime(10);
inline constexpr std::chrono::seconds kIdleTime(30);

class Stream;

/// What streams and connections know of their server.
struct ServerState {
  ServerOwner owner;
  Rules rules;
  int connections = 0;
  int clients = 0;
  std::int64_t refused = 0;
  /// The owner may be gone: it is not called any more.
  bool is_closing = false;
  std::vector<std::weak_ptr<Stream>> streams;
};

/// One client of a WebSocket, whatever is spoken.
class Stream : public std::enable_shared_from_this<Stream> {
 public:
  Stream(beast::tcp_stream stream, ServerState& server)
      : server_(server), socket_(std::move(stream)) {
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

  /// Sends what is next, if nothing is on its way.
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
  /// What lies in a stream until it has been sent.
  struct Outgoing {
    asio::const_buffer buffer;
    bool is_text;
  };

  virtual std::optional<Outgoing> next() = 0;
  virtual void hear(std::string_view bytes, bool is_text) = 0;

  ServerState& server_;

 private:
  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->end();
      const auto bytes = self->buffer_.data();
      self->hear({static_cast<const char*>(bytes.data()), bytes.size()}, self->socket_.got_text());
      self->buffer_.clear();
      self->write();
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

/// The page. Its number is the owner's.
class LiveStream : public Stream {
 public:
  LiveStream(beast::tcp_stream stream, ServerState& server)
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

  void hear(std::string_view bytes, bool is_text) override {
    if (is_text) server_.owner.hear(number_, bytes);
  }

  const int number_;
  Frame frame_;
};

/// Somebody else's viewer.
class ForeignStream : public Stream {
 public:
  ForeignStream(beast::tcp_stream stream, ServerState& server)
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
  }

  const int number_;
  SocketMessage message_;
};

}  // namespace voxlist::viewing
