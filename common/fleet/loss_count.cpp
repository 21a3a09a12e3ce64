#include "voxlist/fleet/loss_count.h"

#include <algorithm>

namespace voxlist::fleet {
namespace {

// More than a relay can have sent; sums of two stay far from overflow.
constexpr std::int64_t kMostSent = 1'000'000'000'000'000;

}  // namespace

void LossCount::hear(const std::string& channel) {
  const auto known = channels_.find(channel);
  if (known != channels_.end()) return void(++known->second.heard);
  if (channels_.size() < kMostChannels) channels_[channel].heard = 1;
}

SentCounts LossCount::told(std::int32_t pid, const SentCounts& sent) {
  if (pid_ != pid) {
    pid_ = pid;
    begin(sent);
    return {};
  }
  SentCounts lost;
  for (const auto& [name, count] : sent) {
    if (!channels_.contains(name) && channels_.size() >= kMostChannels) continue;
    Channel& channel = channels_[name];
    const std::int64_t missing = std::clamp<std::int64_t>(count, 0, kMostSent) - channel.heard;
    if (missing <= channel.known_missing) continue;
    lost[name] = missing - channel.known_missing;
    channel.known_missing = missing;
  }
  return lost;
}

void LossCount::begin(const SentCounts& sent) {
  channels_.clear();
  for (const auto& [name, count] : sent) {
    if (channels_.size() >= kMostChannels) return;
    channels_[name].known_missing = std::clamp<std::int64_t>(count, 0, kMostSent);
  }
}

}  // namespace voxlist::fleet
