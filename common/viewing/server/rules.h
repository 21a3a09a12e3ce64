#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
  /// WebSocket protocols of others' viewers, which only look on, and the pages elsewhere that may
  /// speak them, such as https://app.foxglove.dev.
  std::vector<std::string> foreign_protocols{}, foreign_origins{};
};

/// The page's own WebSocket protocol. Others may stand beside it on the same port.
inline constexpr std::string_view kLiveProtocol = "voxlist.live.v1";

/// Where commands are posted, before their names; where the WebSocket is.
inline constexpr std::string_view kCommandPath = "/command/";
inline constexpr std::string_view kLivePath = "/live";

/// Longest body of a command, and longest frame of a client.
inline constexpr std::size_t kMostBytes = 65'536;

/// What is done with a request.
enum class Deed { kFile, kUpgrade, kForeignUpgrade, kCommand, kRefuse };

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

/// The first of the foreign protocols that a client asks for; null where it asks for none, or for
/// the page's own.
const std::string* foreign_protocol(const Asked& asked, const Rules& rules);

}  // namespace voxlist::viewing
