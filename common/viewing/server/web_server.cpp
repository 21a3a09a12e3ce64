#include "voxlist/viewing/server/web_server.h"

#include <cstdlib>
#include <random>
#include <stdexcept>

#include "voxlist/viewing/server/connection.h"
#include "voxlist/viewing/server/http_messages.h"
#include "voxlist/viewing/server/streams.h"

namespace voxlist::viewing {
namespace {

constexpr int kMostConnections = 64;

// What the kernel holds of what a client has not read: a slow one sees newer content for it.
constexpr int kSendBufferBytes = 256 * 1024;

// Steps of one poll(): some milliseconds. Who floods the server waits, and nobody else.
constexpr int kStepsAtOnce = 500;

std::string random_token() {
  std::random_device random;
  std::string token;
  for (int i = 0; i < 32; ++i) token += "0123456789abcdef"[random() % 16];
  return token;
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

struct WebServer::Impl {
  explicit Impl(ServerOwner owner) {
    state.owner = std::move(owner);
    state.rules.token = random_token();
    state.rules.foreign_protocols = state.owner.foreign.names;
    state.rules.foreign_origins = state.owner.foreign.origins;
  }

  void listen(const ServerOptions& options);
  void accept();

  ServerState state;
  // Its end ends connections and streams, which look at what is above.
  asio::io_context io;
  tcp::acceptor acceptor{io};
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
  state.rules.port = acceptor.local_endpoint().port();
  state.rules.is_open = !acceptor.local_endpoint().address().is_loopback();
  accept();
} catch (const std::exception& error) {
  throw std::runtime_error("cannot serve the page on " + options.address + ":" +
                           std::to_string(options.port) + ": " + error.what());
}

void WebServer::Impl::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error && state.connections + state.clients < kMostConnections) {
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      socket.set_option(asio::socket_base::send_buffer_size(kSendBufferBytes), ignored);
      std::make_shared<Connection>(std::move(socket), state)->read();
    }
    accept();
  });
}

WebServer::WebServer(const ServerOptions& options, ServerOwner owner)
    : impl_(std::make_shared<Impl>(std::move(owner))) {
  impl_->listen(options);
}

WebServer::~WebServer() { impl_->state.is_closing = true; }

void WebServer::poll() {
  for (const auto& stream : impl_->state.streams)
    if (const auto open = stream.lock()) open->write();
  impl_->io.restart();
  for (int step = 0; step < kStepsAtOnce && impl_->io.poll_one() > 0; ++step) {
  }
}

std::uint16_t WebServer::port() const { return impl_->state.rules.port; }
int WebServer::clients() const { return impl_->state.clients; }
std::int64_t WebServer::refused() const { return impl_->state.refused; }
const std::string& WebServer::token() const { return impl_->state.rules.token; }

}  // namespace voxlist::viewing
