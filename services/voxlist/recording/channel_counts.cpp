#include "services/voxlist/recording/channel_counts.h"

#include <fmt/core.h>

namespace voxlist::desk {

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
