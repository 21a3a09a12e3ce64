#include "services/octomap_export/keyframe_queue.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace voxlist::services {

bool KeyframeQueue::is_contradicted_by(const bus::PosedCloud& keyframe) const {
  return keyframe.index < next_index() &&
         handed_out_us_[static_cast<std::size_t>(keyframe.index)] != keyframe.cloud.utime_us;
}

bool KeyframeQueue::is_of_another_map(const bus::PosedCloud& keyframe) const {
  return map_id_ != keyframe.map_id || is_contradicted_by(keyframe);
}

KeyframeQueue::Verdict KeyframeQueue::add(bus::PosedCloud keyframe) {
  if (is_of_another_map(keyframe)) {
    *this = {};
    map_id_ = keyframe.map_id;
  }
  const std::int32_t index = keyframe.index;
  last_known_ = std::max(last_known_, index);
  if (index < next_index() || !waiting_.emplace(index, std::move(keyframe)).second)
    return Verdict::kRepeated;
  if (waiting_.size() <= kCapacity) return Verdict::kTaken;
  waiting_.erase(std::prev(waiting_.end()));
  return Verdict::kDroppedOne;
}

void KeyframeQueue::know_of(std::int64_t map_id, std::int32_t keyframes) {
  if (map_id_ != map_id || keyframes < next_index()) start_over();
  map_id_ = map_id;
  last_known_ = keyframes - 1;
  waiting_.erase(waiting_.lower_bound(keyframes), waiting_.end());
}

std::optional<bus::PosedCloud> KeyframeQueue::next() {
  auto node = waiting_.extract(next_index());
  if (!node) return std::nullopt;
  handed_out_us_.push_back(node.mapped().cloud.utime_us);
  return std::move(node.mapped());
}

std::optional<std::int32_t> KeyframeQueue::missing() const {
  const bool knows_of_more = !map_id_ || last_known_ >= next_index();
  if (!knows_of_more || waiting_.contains(next_index())) return std::nullopt;
  return next_index();
}

bool KeyframeQueue::is_done() const { return map_id_ && last_known_ < next_index(); }

}  // namespace voxlist::services
