// The mapper's map when its loops are closed: in its folder, and for who listens.
#include <gtest/gtest.h>

#include <optional>

#include "tests/services/mapper/bent_drive.h"
#include "tests/services/mapper/mapper_scene.h"
#include "tests/stored_map.h"
#include "tests/temporary_folder.h"

namespace voxlist::services {
namespace {

// As the desk tool closes them.
mapping::MapBuilder closed_at_the_desk(const BentDrive& drive) {
  mapping::MapKeyframes keyframes;
  for (std::size_t i = 0; i < drive.size(); ++i)
    keyframes.push_back({drive.keyframe(i).cloud.utime_us, drive.bent[i]});
  const auto closing = mapping::close_sessions(
      keyframes, [&](std::size_t i) { return drive.keyframe(i).cloud; }, {});
  const mapping::MapKeyframes closed = mapping::moved(keyframes, closing);
  mapping::MapBuilder builder;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    mapping::Keyframe keyframe = drive.keyframe(i);
    mapping::stand_at(closed[i], keyframe.T_map_base);
    builder.add(std::move(keyframe));
  }
  return builder;
}

TEST(ClosedMap, IsTheDesksForListenersAndInTheFolderAndAtTheNextStart) {
  const BentDrive drive;
  const test::TemporaryFolder folder;
  std::optional<MapperScene> live(std::in_place, folder.string());
  for (std::size_t i = 0; i < drive.size(); ++i) live->drive(drive.keyframe(i));
  const OccupancyMap before = live->map;
  live->service->stop();
  for (int i = 0; i < 10; ++i) live->run();

  const mapping::MapBuilder desk = closed_at_the_desk(drive);
  EXPECT_LT(mapping::rmse_m(planar(desk.poses()), drive.truth), 0.03);
  EXPECT_NE(before.occupied.hash(), desk.map().occupied.hash());
  EXPECT_EQ(live->map.occupied.hash(), desk.map().occupied.hash());
  EXPECT_EQ(live->map.passed.hash(), desk.map().passed.hash());
  const bus::MapChange& change = live->changes.back();
  EXPECT_EQ(change.moves, 1);
  EXPECT_EQ(change.version, static_cast<std::int64_t>(drive.size()) + 1);
  EXPECT_EQ(change.base_version, static_cast<std::int64_t>(drive.size()));
  EXPECT_LT(distance_m(change.T_new_old * drive.bent.back(), planar(desk.poses()).back()), 1e-6);
  const auto trajectory = test::load_map(folder.string()).keyframes;
  ASSERT_EQ(trajectory.size(), drive.size());
  live.reset();

  MapperScene again(folder.string());
  for (int i = 0; i < 10; ++i) again.run();
  ASSERT_TRUE(again.assembler.held());
  EXPECT_EQ(again.map.occupied.hash(), desk.map().occupied.hash());
  EXPECT_EQ(again.assembler.held()->version, static_cast<std::int64_t>(drive.size()) + 1);
  mapping::Keyframe more = drive.keyframe(1);
  more.cloud.utime_us += 1'000'000'000;
  again.drive(more);
  EXPECT_EQ(again.assembler.held()->version, static_cast<std::int64_t>(drive.size()) + 2);
}

}  // namespace
}  // namespace voxlist::services
