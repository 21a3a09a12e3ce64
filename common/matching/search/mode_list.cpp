#include "voxlist/matching/search/mode_list.h"

#include <algorithm>
#include <cmath>

namespace voxlist::matching {

int ModeList::least() const {
  return std::max({1, floor(), full() ? modes_.back().overlap + 1 : 0});
}

void ModeList::add(const OverlapMode& pose) {
  if (pose.overlap < least()) return;
  poses_.push_back(pose);
  if (!hidden(pose)) choose_modes();
}

int ModeList::floor() const { return static_cast<int>(std::ceil(config_.mode_ratio * best())); }

// Whether a mode that is as good stands so near that the pose is no mode of its own.
bool ModeList::hidden(const OverlapMode& pose) const {
  return std::any_of(modes_.begin(), modes_.end(), [&](const OverlapMode& mode) {
    return mode.overlap >= pose.overlap &&
           distance_m(mode.pose, pose.pose) < config_.mode_distance_m &&
           turn_rad(mode.pose, pose.pose) < config_.mode_turn_rad;
  });
}

// Chooses anew from all poses: the modes that a new one hides may have hidden others.
void ModeList::choose_modes() {
  std::stable_sort(poses_.begin(), poses_.end(),
                   [](const auto& a, const auto& b) { return a.overlap > b.overlap; });
  modes_.assign(1, poses_.front());
  std::erase_if(poses_, [&](const OverlapMode& pose) { return pose.overlap < floor(); });
  for (const OverlapMode& pose : poses_)
    if (!full() && !hidden(pose)) modes_.push_back(pose);
}

}  // namespace voxlist::matching
