#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace voxlist::viewing {

/// What one request says that decides whether it is answered. Where a header is not there it is
/// nothing; where one that may be there once is there twice, `repeats_a_header`.
struct Asked {
  std::string_view method, target;
  std::optional<std::string_view> host{}, origin{}, content_type{}, token{}, subprotocols{};
  bool wants_upgrade = false;
  bool repeats_a_header = false;
};

/// Who may ask.
struct Rules {
  std::uint16_t port = 0;
  std::string token;
  /// The address is not loopback, so Host may be any address that is written in numbers.
  bool is_open = false;
};

/// The page's own WebSocket protocol. Others may stand beside it on the same port.
inline constexpr std::string_view kLiveProtocol = "voxlist.live.v1";

/// Where commands are posted, before their names; where the WebSocket is.
inline constexpr std::string_view kCommandPath = "/command/";
inline constexpr std::string_view kLivePath = "/live";

/// Longest body of a command, and longest frame of a client.
inline constexpr std::size_t kMostBytes = 65'536;

/// What is done with a request.
enum class Deed { kFile, kUpgrade, kCommand, kRefuse };

struct Ruling {
  Deed deed;
  /// The HTTP status of a refusal, and why, for a person.
  unsigned status = 200;
  const char* why = "";
};

/// Loopback is no access control: every page that a browser has open can send requests there. So a
/// request must name this server as its host (no other name can be made to lead here), a WebSocket
/// must come from this server's own page or from no page, and a command must carry the token that
/// only that page knows.
Ruling rule(const Asked& asked, const Rules& rules);

/// Whether a list such as "a, b" has the word.
bool lists(std::string_view list, std::string_view word);

}  // namespace voxlist::viewing
