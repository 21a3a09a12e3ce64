#include "voxlist/voxels/edits/edited_map.h"

#include <utility>

namespace voxlist {
namespace {

using Kinds = std::vector<EditKind>;
constexpr auto kErase = EditKind::kErase, kFree = EditKind::kKeepFree,
               kBlocked = EditKind::kKeepBlocked;

}  // namespace

ChangedBlocks EditedMap::take(const OccupancyMap& map, std::vector<PlacedBox> boxes,
                              const ChangedBlocks& changed) {
  // A blocked box over an erased one does not bring back what was there.
  if (use_ == EditUse::kMatching)
    std::erase_if(boxes, [](const PlacedBox& box) { return box.kind == kBlocked; });
  if (!edited_ && boxes.empty()) return changed;
  const EditedMap before = std::exchange(*this, EditedMap(use_));
  if (!boxes.empty()) make_anew(map, boxes);
  return difference(before.of(map), of(map));
}

void EditedMap::make_anew(const OccupancyMap& map, const std::vector<PlacedBox>& boxes) {
  const bool matching = use_ == EditUse::kMatching;
  VoxelEdits occupied(boxes, map.occupied.resolution_m(), {kErase, kFree},
                      matching ? Kinds{} : Kinds{kBlocked});
  VoxelEdits passed(boxes, map.passed.resolution_m(),
                    matching ? Kinds{kErase, kFree} : Kinds{kBlocked},
                    matching ? Kinds{} : Kinds{kFree});
  OccupancyMap edited{occupied.apply(map.occupied), passed.apply(map.passed)};
  edited_.emplace(Edited{std::move(occupied), std::move(passed), std::move(edited)});
}

ChangedBlocks EditedMap::follow(const OccupancyMap& map, const ChangedBlocks& changed) {
  if (!edited_) return changed;
  ChangedBlocks here;
  here.from = edited_->map.revision();
  here.occupied = edited_->occupied.follow(map.occupied, changed.occupied, edited_->map.occupied);
  here.passed = edited_->passed.follow(map.passed, changed.passed, edited_->map.passed);
  here.to = edited_->map.revision();
  return here;
}

}  // namespace voxlist
