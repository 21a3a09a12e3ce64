#include "services/octomap_export/edit_follower.h"

#include <utility>
#include <voxlist/map_edits_t.hpp>

#include "voxlist/bus/health.h"

namespace voxlist::services {
namespace {

// What was said on MAP_UPDATE follows on MAP_EDITS within this time (us), or was lost.
constexpr std::int64_t kPatience_us = 200'000;

constexpr std::int64_t kAskPeriod_us = 1'000'000;

}  // namespace

void EditFollower::take(const map_edits_t& message) {
  if (!message.refusal.empty()) return;
  auto boxes = bus::from_message(message);
  if (!boxes) return health_.count("MAP_EDITS/refused");
  heard_ = std::move(*boxes);
}

std::optional<std::vector<PlacedBox>> EditFollower::news(const Word& word) {
  const bool has_none = word.edits == 0;
  if (has_none ? held_.boxes.empty() : is_of(held_, word) || !is_of(heard_, word))
    return std::nullopt;
  held_ = has_none ? bus::EditedBoxes{} : heard_;
  return held_.boxes;
}

bool EditFollower::is_due(const Word& word, std::int64_t now_us) {
  if (follows(word)) {
    missed_since_us_.reset();
    return false;
  }
  if (!missed_since_us_) missed_since_us_ = now_us;
  if (now_us - *missed_since_us_ < kPatience_us) return false;
  if (asked_us_ && now_us - *asked_us_ < kAskPeriod_us) return false;
  asked_us_ = now_us;
  return true;
}

}  // namespace voxlist::services
