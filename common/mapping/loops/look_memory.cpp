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
  const auto found = looks_.neighbours.find({from, to});
  if (found == looks_.neighbours.end() || !are_alike(found->second, expected)) return std::nullopt;
  return found->second;
}

void LookMemory::keep(std::size_t from, std::size_t to, const NeighbourLook& look) {
  const std::lock_guard lock(mutex_);
  looks_.neighbours.insert_or_assign({from, to}, look);
}

std::optional<TakenLook> LookMemory::loop_look(std::size_t keyframe) const {
  const std::lock_guard lock(mutex_);
  const auto found = looks_.loops.find(keyframe);
  return found == looks_.loops.end() ? std::nullopt : std::optional(found->second);
}

void LookMemory::keep(TakenLook look) {
  const std::lock_guard lock(mutex_);
  const std::size_t keyframe = look.look.keyframe;
  looks_.loops.insert_or_assign(keyframe, std::move(look));
}

std::optional<TakenSpatialLook> LookMemory::in_space(const SpatialLook& look) const {
  const std::lock_guard lock(mutex_);
  const auto found = looks_.in_space.find(ends_of(look));
  if (found == looks_.in_space.end()) return std::nullopt;
  for (const TakenSpatialLook& taken : found->second)
    if (taken.look == look) return taken;
  return std::nullopt;
}

void LookMemory::keep(TakenSpatialLook look) {
  const std::lock_guard lock(mutex_);
  std::vector<TakenSpatialLook>& taken = looks_.in_space[ends_of(look.look)];
  if (taken.size() == kSpatialLooks) taken.erase(taken.begin());
  taken.push_back(std::move(look));
}

LookMemory::Looks LookMemory::all() const {
  const std::lock_guard lock(mutex_);
  return looks_;
}

void LookMemory::take(Looks looks) {
  const std::lock_guard lock(mutex_);
  looks_ = std::move(looks);
}

void LookMemory::clear() { take({}); }

}  // namespace voxlist::mapping
