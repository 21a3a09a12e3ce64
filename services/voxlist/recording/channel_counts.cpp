#include "services/voxlist/recording/channel_counts.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cctype>

namespace voxlist::desk {

std::string ChannelCounts::why_without(const std::string& channel, const std::string& prefix,
                                       const std::string& remedy) const {
  const std::string why = fmt::format("has no {}{}; it holds {}", prefix, channel, text());
  const std::vector<std::string> others = prefixes_of(channel);
  if (others.empty()) return why + remedy;
  return fmt::format("{}: give --prefix {}, or the robot's settings with --config", why,
                     fmt::join(others, " or "));
}

// Before a name there is a sign that ends a word, or nothing: "robot2/", "a_", but not "POINT" of
// POINTCLOUD.
std::vector<std::string> ChannelCounts::prefixes_of(const std::string& channel) const {
  std::vector<std::string> prefixes;
  for (const auto& [name, count] : counts_) {
    if (!name.ends_with(channel)) continue;
    const std::string prefix = name.substr(0, name.size() - channel.size());
    if (prefix.empty()) prefixes.emplace_back("''");
    if (!prefix.empty() && std::isalnum(static_cast<unsigned char>(prefix.back())) == 0)
      prefixes.push_back(prefix);
  }
  return prefixes;
}

// Ten channels at most.
std::string ChannelCounts::text() const {
  constexpr std::size_t kTold = 10;
  std::string text;
  std::size_t told = 0;
  for (const auto& [channel, count] : counts_) {
    if (told++ == kTold) return fmt::format("{} and {} more", text, counts_.size() - kTold);
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", channel, count);
  }
  return text.empty() ? "nothing" : text;
}

}  // namespace voxlist::desk
