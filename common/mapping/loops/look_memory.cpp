#include "voxlist/mapping/loops/look_memory.h"

namespace voxlist::mapping {

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

void LookMemory::clear() {
  const std::lock_guard lock(mutex_);
  neighbours_.clear();
  loops_.clear();
}

}  // namespace voxlist::mapping
