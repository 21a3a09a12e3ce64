#pragma once

// For web_server.cpp alone, as all that includes Boost.Beast: it takes 22 s to compile.
// Asio 1.74 forgets that it needs this with C++20.
// clang-format off
#include <utility>
// clang-format on

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <optional>
#include <string_view>

#include "voxlist/viewing/server/rules.h"

namespace voxlist::viewing {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

inline std::string_view text(beast::string_view view) { return {view.data(), view.size()}; }

/// A header's value; nothing where it is not there.
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

inline constexpr const char* kTokenHeader = "X-Voxlist-Token";

/// What of a request decides whether it is answered. Points into the request.
inline Asked asked_by(const Request& request) {
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

/// A response with the headers that keep other pages out of this one.
inline Response answer(const Request& request, unsigned status, std::string_view type,
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

}  // namespace voxlist::viewing
