// Scans in a map whose boxes were edited by hand.
#include <gtest/gtest.h>

#include "tests/bench/answers.h"
#include "voxlist/matching/localisation/localiser.h"
#include "voxlist/voxels/edits/edited_map.h"

namespace voxlist::mapping {
namespace {

// Sets blocks to what another map has there; returns them.
std::vector<Voxel> copy(const std::vector<Voxel>& blocks, const VoxelMap& from, VoxelMap& to) {
  for (const Voxel& block : blocks) {
    const VoxelBlock* const bits = from.find_block(block);
    to.set_block(block, bits ? *bits : VoxelBlock{});
  }
  return blocks;
}

// As a listener's map follows the mapper's.
ChangedBlocks follow(const ChangedBlocks& changed, const OccupancyMap& theirs, OccupancyMap& mine) {
  ChangedBlocks here;
  here.from = mine.revision();
  here.occupied = copy(changed.occupied, theirs.occupied, mine.occupied);
  here.passed = copy(changed.passed, theirs.passed, mine.passed);
  here.to = mine.revision();
  return here;
}

TEST(Localiser, FollowsEditsWithTheSameBitsAsInAMapMadeAnew) {
  const bench::TestFloor floor = bench::make_test_floor(bench::few_scans_floor(1));
  OccupancyMap mine = floor.map;
  matching::Localiser follower(mine);
  const auto queries = bench::scans_about({"as mapped"}, floor, floor.building, 4, 5);
  follower.locate(queries.front().scan);  // what it prepares is of the map before

  EditedMap edited(EditUse::kMatching);
  const Eigen::Vector3d middle(0.5 * (floor.low.x() + floor.high.x()), 0.0, 0.0);
  PlacedBox turned{EditKind::kKeepFree, {Eigen::Vector3d(-1, -1, 0.1), Eigen::Vector3d(1, 1, 2)}};
  turned.T_map_box = {middle.x(), middle.y(), 0.4};
  const PlacedBox aside{EditKind::kErase, {middle, Eigen::Vector3d(middle.x() + 3, 4, 2)}};
  const ChangedBlocks changed =
      edited.take(floor.map, {turned, aside}, {{}, {}, floor.map.revision(), floor.map.revision()});
  ASSERT_GT(changed.occupied.size(), 100U);
  follower.map_changed(follow(changed, edited.of(floor.map), mine));

  matching::Localiser anew(edited.of(floor.map));
  for (const bench::Query& query : queries) {
    const auto a = follower.locate(query.scan), b = anew.locate(query.scan);
    EXPECT_EQ(a.state, b.state);
    EXPECT_EQ(a.confidence, b.confidence);
    ASSERT_EQ(a.modes.size(), b.modes.size());
    for (std::size_t i = 0; i < a.modes.size(); ++i) {
      EXPECT_EQ(a.modes[i].T_map_base, b.modes[i].T_map_base);
      EXPECT_EQ(a.modes[i].probability, b.modes[i].probability);
    }
  }
}

}  // namespace
}  // namespace voxlist::mapping
