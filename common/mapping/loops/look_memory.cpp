#include "voxlist/mapping/loops/look_memory.h"

namespace voxlist::mapping {
namespace {

// So many looks in space at the same two keyframes are remembered: of the drive, of a loop from
// either end, and one more.
constexpr std::size_t kSpatialLooks = 4;

std::pair<std::size_t, std::size_t> ends_of(const SpatialLook& look) {
  return {look.others.front().keyframe, look.keyframe};
}

}  // namespace

bool LoopLook::operator==(const LoopLook& other) const {
  return keyframe == other.keyframe && reach_m == other.reach_m && from == other.from &&
         predicted.pose == other.predicted.pose &&
         predicted.covariance == other.predicted.covariance && round == other.round;
}

std::optional<NeighbourLook> LookMemory::neighbours(std::size_t from, std::size_t to,
                                                    const NeighbourLook& expected) const {
  const std::lock_guard lock(mutex_);
  const auto found = neighbours_.find({from, to});
  if (found == neighbours_.end() || !are_alike(found->second, expected)) return std::nullopt;
  return found->second;
}

void LookMemory::keep(std::size_t from, std::size_t to, const NeighbourLook& look) {
  const std::lock_guard lock(mutex_);
  neighbours_.insert_or_assign({from, to}, look);
}

std::optional<TakenLook> LookMemory::loop_look(std::size_t keyframe) const {
  const std::lock_guard lock(mutex_);
  const auto found = loops_.find(keyframe);
  return found == loops_.end() ? std::nullopt : std::optional(found->second);
}

void LookMemory::keep(TakenLook look) {
  const std::lock_guard lock(mutex_);
  const std::size_t keyframe = look.look.keyframe;
  loops_.insert_or_assign(keyframe, std::move(look));
}

std::optional<TakenSpatialLook> LookMemory::in_space(const SpatialLook& look) const {
  const std::lock_guard lock(mutex_);
  const auto found = in_space_.find(ends_of(look));
  if (found == in_space_.end()) return std::nullopt;
  for (const TakenSpatialLook& taken : found->second)
    if (taken.look == look) return taken;
  return std::nullopt;
}

void LookMemory::keep(TakenSpatialLook look) {
  const std::lock_guard lock(mutex_);
  std::vector<TakenSpatialLook>& taken = in_space_[ends_of(look.look)];
  if (taken.size() == kSpatialLooks) taken.erase(taken.begin());
  taken.push_back(std::move(look));
}

void LookMemory::clear() {
  const std::lock_guard lock(mutex_);
  neighbours_.clear();
  loops_.clear();
  in_space_.clear();
}

}  // namespace voxlist::mapping
