#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace voxlist::fleet {

/// How many messages of each channel a relay has sent, since it was started.
using SentCounts = std::map<std::string, std::int64_t>;

/// What got lost between one robot's relay and this one: relays tell once a second how much they
/// have sent, and that is compared with what came.
class LossCount {
 public:
  /// Most channels of a robot: their names come from the network.
  static constexpr std::size_t kMostChannels = 100;

  /// A message of the channel came.
  void hear(const std::string& channel);

  /// The relay, which is this process of its machine, says what it has sent so far. What of it did
  /// not come and was not told before: by channel, none that is 0. The first word of a process only
  /// says where to begin.
  SentCounts told(std::int32_t pid, const SentCounts& sent);

 private:
  struct Channel {
    std::int64_t heard = 0;
    std::int64_t known_missing = 0;  // sent, but not heard; before it began, and told since
  };

  void begin(const SentCounts& sent);

  std::optional<std::int32_t> pid_;
  std::map<std::string, Channel> channels_;
};

}  // namespace voxlist::fleet
