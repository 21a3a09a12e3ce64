// A robot without odometry that is covered between two rooms: it leaves its map, maps on, and comes
// back or does not. Localiser and mapper together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "services/mapper/apart/apart_file.h"
#include "tests/services/localiser_and_mapper.h"
#include "tests/simulation/room_drive.h"
#include "tests/stored_map.h"
#include "tests/temporary_folder.h"

namespace voxlist::services {
namespace {

using testing::HasSubstr;
using testing::Not;

class LeavingMap : public testing::Test {
 protected:
  // One room is mapped; the robot is in the other one, and has looked round there.
  void leave(std::size_t first, std::size_t second) {
    drive_.stand_in(first);
    drive_.look_round(first);
    known_poses_ = live_.poses.size();
    drive_.drive(first, second, true);
    drive_.look_round(second);
  }

  void come_back(bool covered) {
    drive_.drive(1, 0, covered);
    drive_.look_round(0);
    drive_.drive(0, 0, false);
  }

  // Every pose that was published, and every keyframe of the map, is where the robot was.
  void expect_all_true() const {
    for (const pose_t& pose : live_.poses) expect_true(pose.utime, {pose.pos[0], pose.pos[1], 0.0});
    for (const mapping::Keyframe& keyframe : keyframes())
      expect_true(keyframe.cloud.utime_us, to_pose2(keyframe.T_map_base));
  }

  // The map's frame is where its first cloud was taken.
  void expect_true(std::int64_t utime_us, const Pose2& told) const {
    const Pose2 truth = truth_.begin()->second.inverse() * truth_.at(utime_us);
    EXPECT_LT(distance_m(told, truth), 0.1) << utime_us;
  }

  std::vector<mapping::Keyframe> keyframes() const {
    return test::load_map(folder_.string()).keyframes;
  }

  // Keyframes that were taken near a room's middle.
  std::size_t keyframes_in(std::size_t room) const {
    std::size_t count = 0;
    for (const mapping::Keyframe& keyframe : keyframes())
      count += distance_m(truth_.at(keyframe.cloud.utime_us), drive_.middle_of(room)) < 2.0;
    return count;
  }

  std::string health() const { return live_.mapper->health.message(); }
  bool is_recorded(const char* ending = "") const {
    return exists(folder_.path() / (std::string(kApartFile) + ending));
  }

  const test::TemporaryFolder folder_;
  LocaliserAndMapper live_{folder_.string()};
  std::map<std::int64_t, Pose2> truth_;
  simulation::RoomDrive drive_{
      1, [this](const Cloud& cloud, const Pose2& truth) { truth_[live_.send(cloud)] = truth; }};
  std::size_t known_poses_ = 0;
};

TEST_F(LeavingMap, MapsOnApartAndHasNoPose) {
  leave(0, 1);
  EXPECT_THAT(health(), HasSubstr("mapping apart"));
  EXPECT_EQ(live_.poses.size(), known_poses_);
  EXPECT_GT(known_poses_, 0U);
  EXPECT_EQ(keyframes_in(1), 0U);
}

// By then the robot may be anywhere, as far as it was followed.
TEST_F(LeavingMap, IsNotInARoomThatLooksMuchLikeTheOneThatItLeft) {
  leave(1, 3);
  EXPECT_EQ(live_.poses.size(), known_poses_);
  EXPECT_GT(known_poses_, 0U);
}

// However long it was covered.
TEST_F(LeavingMap, IsFoundAtOnceWhereItStood) {
  drive_.stand_in(0);
  drive_.look_round(0);
  known_poses_ = live_.poses.size();
  Cloud lid;
  lid.points.emplace_back(0.3F, 0.0F, 0.0F);
  for (int i = 0; i < 20; ++i) live_.send(lid);
  drive_.look_round(0);
  EXPECT_EQ(live_.poses.size(), truth_.size());
  EXPECT_GT(truth_.size(), known_poses_ + 5);
  EXPECT_THAT(health(), Not(HasSubstr("apart")));
}

TEST_F(LeavingMap, JoinsWhenItIsBack) {
  leave(0, 1);
  come_back(false);
  EXPECT_THAT(health(), Not(HasSubstr("apart")));
  EXPECT_FALSE(is_recorded());
  EXPECT_GE(keyframes_in(1), 2U);
  EXPECT_GT(live_.poses.size(), known_poses_);
  expect_all_true();
}

TEST_F(LeavingMap, KeepsThePieceWhereItNeverComesBack) {
  leave(0, 1);
  live_.mapper->service.stop();
  EXPECT_TRUE(is_recorded());
  EXPECT_EQ(keyframes_in(1), 0U);
  live_.start_mapper();
  EXPECT_THAT(health(), HasSubstr("mapping apart"));
}

TEST_F(LeavingMap, GoesOnWithThePieceOfAMapperThatDied) {
  leave(0, 1);
  live_.start_mapper();
  live_.run(1.0);
  come_back(false);
  EXPECT_FALSE(is_recorded());
  EXPECT_FALSE(is_recorded("-1"));
  EXPECT_GE(keyframes_in(1), 2U);
  expect_all_true();
}

TEST_F(LeavingMap, LeavesThePieceWhereNoCloudFitsBoth) {
  leave(0, 1);
  come_back(true);
  EXPECT_EQ(keyframes_in(1), 0U);
  EXPECT_TRUE(is_recorded("-1"));
  EXPECT_THAT(health(), HasSubstr("voxlist extend"));
  expect_all_true();
}

}  // namespace
}  // namespace voxlist::services
