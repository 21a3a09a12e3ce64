// A session that begins on a saved map, where the map ends; and one that leaves it there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "tests/services/mapper/bent_drive.h"
#include "tests/services/mapper/mapper_scene.h"
#include "tests/stored_map.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/event_log.h"

namespace voxlist::services {
namespace {

// The map is the first of four sides of a block. The robot begins on the second one, and is found
// at five places of the first; where the map's newest keyframe was taken, it adds none.
constexpr std::size_t kMapped = 12, kFirst = 22, kFound = 5, kNew = kFound - 1;

class ApartSessionTest : public testing::Test {
 protected:
  ApartSessionTest() {
    mapping::MapStore store(folder_.path(), 1, [](mapping::Keyframe) {});
    for (std::size_t i = 0; i < kMapped; ++i) store.append(seen_from(i, i + 1));
  }

  mapping::Keyframe seen_from(std::size_t place, std::size_t second) const {
    mapping::Keyframe keyframe{to_pose3(drive_.truth[place]),
                               mapping::scan_block(drive_.truth[place], second)};
    keyframe.cloud.utime_us = static_cast<std::int64_t>(second) * 1'000'000;
    return keyframe;
  }

  // What the robot sees on its way from kFirst to `last`, lost; wheels begin anywhere. `carried`:
  // it sees what is so many places on.
  void drive_lost(MapperScene& live, std::size_t last, std::size_t carried = 0) {
    for (std::size_t place = kFirst; place >= last; --place) step(live, place, carried, false);
  }

  void drive_found(MapperScene& live) {
    for (std::size_t i = 1; i <= kFound; ++i) step(live, kMapped - i, 0, true);
  }

  // `error`: of the pose that the localiser tells.
  void step(MapperScene& live, std::size_t place, std::size_t carried, bool found,
            const Pose2& error = {}) {
    mapping::Keyframe seen = seen_from(place + carried, ++second_);
    truth_[seen.cloud.utime_us] = drive_.truth[place + carried];
    live.odometry(seen.cloud.utime_us, Pose2{5.0, -3.0, 1.0} * drive_.truth[place]);
    seen.T_map_base = to_pose3(error) * seen.T_map_base;
    found ? live.drive(seen) : live.drive(seen, localisation_t::STATE_LOST);
  }

  std::size_t stored() const { return test::load_map(folder_.string()).keyframes.size(); }
  std::filesystem::path recording() const { return folder_.path() / kApartFile; }

  static std::filesystem::path numbered(const test::TemporaryFolder& folder) {
    return (folder.path() / kApartFile).string() + "-1";
  }

  static std::size_t recorded_clouds(const std::filesystem::path& file) {
    return read_apart_file(file).size();
  }

  // Keyframes of the session, each where it was taken.
  std::size_t joined() const { return joined(folder_.string()); }

  std::size_t joined(const std::string& folder) const {
    std::size_t joined = 0;
    for (const mapping::Keyframe& keyframe : test::load_map(folder).keyframes) {
      const auto truth = truth_.find(keyframe.cloud.utime_us);
      if (truth == truth_.end()) continue;
      ++joined;
      EXPECT_LT(distance_m(to_pose2(keyframe.T_map_base), truth->second), 0.05);
    }
    return joined;
  }

  const BentDrive drive_;
  const test::TemporaryFolder folder_;
  std::size_t second_ = 1000;
  std::map<std::int64_t, Pose2> truth_;
};

TEST_F(ApartSessionTest, IsJoinedToTheMapOnceItIsFoundThere) {
  MapperScene live(folder_.string());
  drive_lost(live, kMapped);
  EXPECT_EQ(stored(), kMapped) << "it is kept apart";
  EXPECT_TRUE(exists(recording()));
  drive_found(live);
  EXPECT_EQ(joined(), kFirst - kMapped + 1 + kNew);
  EXPECT_FALSE(exists(recording()));
}

TEST_F(ApartSessionTest, IsJoinedToTheEndWhenTheMapperStops) {
  MapperScene live(folder_.string());
  drive_lost(live, kMapped);
  for (std::size_t i = 1; i <= 3; ++i) step(live, kMapped - i, 0, true);
  EXPECT_TRUE(exists(recording())) << "not all of it yet";
  live.service->stop();
  EXPECT_GE(joined(), kFirst - kMapped + 1);
  EXPECT_FALSE(exists(recording()));
}

TEST_F(ApartSessionTest, IsToldInHealthAsLongAsItLasts) {
  MapperScene live(folder_.string());
  drive_lost(live, kMapped);
  EXPECT_THAT(live.health(), testing::HasSubstr("mapping apart, 11 keyframes"));
  drive_found(live);
  EXPECT_THAT(live.health(), testing::Not(testing::HasSubstr("apart")));
}

TEST_F(ApartSessionTest, IsRecordedWhereItIsNeverFound) {
  MapperScene live(folder_.string());
  drive_lost(live, kMapped);
  live.service.reset();
  EXPECT_EQ(stored(), kMapped);
  bus::EventLogReader log(recording().string());
  int clouds = 0, poses = 0;
  while (const auto event = log.next()) {
    clouds += event->channel == "CLOUD";
    poses += event->channel == "ODOMETRY";
  }
  EXPECT_EQ(clouds, static_cast<int>(kFirst - kMapped + 1));
  EXPECT_EQ(poses, clouds);
}

// The folder as it is when kill -9 comes, and the power is back.
TEST_F(ApartSessionTest, IsTakenUpByTheNextMapper) {
  MapperScene killed(folder_.string());
  drive_lost(killed, kMapped);
  const test::TemporaryFolder copy;
  std::filesystem::copy(folder_.path(), copy.path());
  MapperScene live(copy.string());
  EXPECT_THAT(live.health(), testing::HasSubstr("mapping apart, 11 keyframes"));
  drive_found(live);
  EXPECT_EQ(joined(copy.string()), kFirst - kMapped + 1 + kNew);
  EXPECT_FALSE(exists(copy.path() / kApartFile));
  EXPECT_FALSE(exists(numbered(copy)));
}

// The wheels did not notice.
TEST_F(ApartSessionTest, StaysApartWhereTheRobotWasCarriedIntoTheMap) {
  MapperScene live(folder_.string());
  drive_lost(live, kMapped, 14);
  drive_found(live);
  EXPECT_EQ(joined(), kNew);
  live.service.reset();
  EXPECT_GE(recorded_clouds(numbered(folder_)), 5U);
  const MapperScene next(folder_.string());
  EXPECT_THAT(next.health(), testing::HasSubstr("apart.lcm-1): voxlist extend"));
}

TEST_F(ApartSessionTest, StaysApartWherePosesInTheMapDisagree) {
  MapperScene live(folder_.string());
  drive_lost(live, kMapped);
  for (std::size_t i = 1; i <= kFound; ++i)
    step(live, kMapped - i, 0, true, {0.5 * static_cast<double>(i), 0.0, 0.0});
  live.service.reset();
  EXPECT_EQ(stored(), kMapped + kFound);
  EXPECT_TRUE(exists(recording()));
}

TEST_F(ApartSessionTest, BeginsWhereTheRobotLeavesTheMap) {
  MapperScene live(folder_.string());
  drive_found(live);
  for (std::size_t place = kMapped; place <= kFirst; ++place) step(live, place, 0, false);
  EXPECT_EQ(stored(), kMapped + kNew) << "they have no place in the map";
  EXPECT_TRUE(exists(recording()));
  drive_lost(live, kMapped);
  drive_found(live);
  for (std::size_t place = kMapped - kFound; place > 4; --place) step(live, place, 0, true);
  const std::size_t near = 5;  // seconds in which it may be back at once
  EXPECT_GE(joined(), 2 * kNew + kFirst - kMapped - near);
  EXPECT_FALSE(exists(recording()));
}

TEST_F(ApartSessionTest, BeginsNotWhereTheRobotIsTooSlowToHaveLeftTheMap) {
  MapperServiceConfig slow;
  slow.max_speed_mps = 0.5;
  MapperScene live(folder_.string(), slow);
  drive_found(live);
  for (std::size_t place = kMapped; place <= kFirst; ++place) step(live, place, 0, false);
  EXPECT_THAT(live.health(), testing::Not(testing::HasSubstr("apart")));
  EXPECT_FALSE(exists(recording()));
}

TEST_F(ApartSessionTest, BeginsNotWhereTheRobotIsBackAtOnce) {
  MapperScene live(folder_.string());
  drive_found(live);
  for (std::size_t place = kMapped; place < kMapped + 4; ++place) step(live, place, 0, false);
  step(live, kMapped - 1, 0, true);
  EXPECT_THAT(live.health(), testing::Not(testing::HasSubstr("apart")));
  EXPECT_FALSE(exists(recording()));
}

TEST_F(ApartSessionTest, HasAPieceForEachPlaceThatHangsTogether) {
  MapperScene live(folder_.string());
  drive_lost(live, kMapped + 5);
  for (std::size_t place = kFirst + 20; place < kFirst + 30; ++place) step(live, place, 0, false);
  live.service.reset();
  EXPECT_EQ(recorded_clouds(numbered(folder_)), kFirst - kMapped - 5 + 1);
  EXPECT_GE(recorded_clouds(recording()), 5U);
}

TEST_F(ApartSessionTest, IsNoneOfAMapThatIsBegun) {
  const test::TemporaryFolder empty;
  MapperScene live(empty.string());
  for (std::size_t i = 0; i < 3; ++i)
    live.drive(seen_from(i, ++second_), localisation_t::STATE_LOST);
  EXPECT_FALSE(exists(empty.path() / kApartFile));
}

}  // namespace
}  // namespace voxlist::services
