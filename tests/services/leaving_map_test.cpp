// A robot that leaves its map where it sees nothing, maps on, and comes back or does not: localiser
// and mapper together.
#include <gmock/gmock.h>

#include <numbers>

#include "services/mapper/apart/apart_file.h"
#include "tests/services/localiser_and_mapper.h"
#include "tests/stored_map.h"
#include "voxlist/simulation/building/floor_plan.h"
#include "voxlist/simulation/random.h"
#include "voxlist/simulation/world/world.h"

namespace voxlist::services {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kStep_m = 0.5, kLaser_m = 1.0;

class LeavingMap : public LocaliserAndMapper {
 protected:
  static simulation::Building building() {
    simulation::BuildingConfig config;
    config.seed = 1;
    return simulation::make_building(config);
  }

  // What a laser with 48 rings sees from a pose, in base.
  Cloud seen_from(const Pose2& pose) {
    simulation::Random random(static_cast<std::uint64_t>(seq_) + 1);
    Cloud cloud;
    const Eigen::Vector3d laser(pose.x_m, pose.y_m, kLaser_m);
    for (int i = 0; i < 48 * 180; ++i) {
      const double up = (-35.0 + 70.0 * (i / 180) / 47.0) * std::numbers::pi / 180.0,
                   turn = 2.0 * (i % 180) * std::numbers::pi / 180.0;
      const Eigen::Vector3d way(std::cos(up) * std::cos(turn), std::cos(up) * std::sin(turn),
                                std::sin(up));
      const auto range_m = world_.range(laser, to_pose3(pose).linear() * way, 0.0);
      if (!range_m || *range_m > 12.0) continue;
      const Eigen::Vector3d end = (*range_m + 0.01 * random.normal()) * way;
      cloud.points.push_back((Eigen::Vector3d(0.0, 0.0, kLaser_m) + end).cast<float>());
      cloud.origins.emplace_back(0.0F, 0.0F, static_cast<float>(kLaser_m));
    }
    return cloud;
  }

  static Cloud lid() {
    Cloud cloud;
    cloud.points.emplace_back(0.3F, 0.0F, 0.0F);
    return cloud;
  }

  // The middle of a room, or its door.
  Pose2 in_room(std::size_t room) const {
    const Eigen::Vector2d at = world_.building().rooms[room].centre();
    return {at.x(), at.y(), 0.3};
  }
  Pose2 at_door(std::size_t room) const {
    const Eigen::Vector2d at = world_.building().rooms[room].door;
    return {at.x(), at.y(), 0.3};
  }

  // Straight to a pose.
  void drive_to(const Pose2& to, bool covered = false) {
    const Pose2 from = at_;
    const int steps = static_cast<int>(std::ceil(distance_m(from, to) / kStep_m));
    for (int i = 1; i <= steps; ++i) {
      at_ = from * part_of(from.inverse() * to, static_cast<double>(i) / steps);
      truth_[send(covered ? lid() : seen_from(at_))] = at_;
    }
  }

  // From room to room by their doors and the corridor between, which is not seen; there is no
  // odometry.
  void drive_covered(std::size_t from, std::size_t to) {
    for (const Pose2& stop : {at_door(from), Pose2{at_door(from).x_m, 0.0, 0.3},
                              Pose2{at_door(to).x_m, 0.0, 0.3}, at_door(to)})
      drive_to(stop, true);
  }

  void map_room(std::size_t room) {
    at_ = in_room(room) * Pose2{-1.0, 0.0, 0.0};
    drive_to(in_room(room));
    drive_to(in_room(room) * Pose2{0.0, 1.0, 0.0});
    T_map_truth_ = told(answers_.front().utime) * truth_.at(answers_.front().utime).inverse();
  }

  void look_round(std::size_t room) {
    drive_to(in_room(room));
    drive_to(in_room(room) * Pose2{1.0, 0.5, 0.0});
    drive_to(in_room(room));
  }

  Pose2 told(std::int64_t utime_us) const {
    for (const localisation_t& answer : answers_)
      if (answer.utime == utime_us && answer.state == localisation_t::STATE_TRACKING)
        return {answer.modes[0].pose[0], answer.modes[0].pose[1], answer.modes[0].pose[2]};
    ADD_FAILURE() << "no pose" << states();
    return {};
  }

  // Every pose that was published, and every keyframe of the map, is where the robot was.
  void expect_all_true() {
    for (const pose_t& pose : poses_) expect_true(pose.utime, {pose.pos[0], pose.pos[1], 0.0});
    for (const mapping::Keyframe& keyframe : keyframes())
      expect_true(keyframe.cloud.utime_us, to_pose2(keyframe.T_map_base));
  }

  void expect_true(std::int64_t utime_us, const Pose2& told) const {
    EXPECT_LT(distance_m(told, T_map_truth_ * truth_.at(utime_us)), 0.1) << utime_us;
  }

  std::vector<mapping::Keyframe> keyframes() const {
    return test::load_map(folder_.string()).keyframes;
  }

  // Keyframes that were taken within 3 m of a room's middle.
  std::size_t keyframes_in(std::size_t room) const {
    std::size_t count = 0;
    for (const mapping::Keyframe& keyframe : keyframes())
      count += distance_m(truth_.at(keyframe.cloud.utime_us), in_room(room)) < 3.0;
    return count;
  }

  std::string states() const {
    std::string states;
    for (const localisation_t& answer : answers_) states += "LAT"[answer.state];
    return states;
  }

  std::string health() const { return mapper_->health.message(); }
  bool is_recorded(const char* ending = "") const {
    return exists(folder_.path() / (std::string(kApartFile) + ending));
  }

  const simulation::World world_{building()};
  Pose2 at_, T_map_truth_;
  std::map<std::int64_t, Pose2> truth_;
};

TEST_F(LeavingMap, MapsOnApartAndJoinsWhenItIsBack) {
  map_room(0);
  const std::size_t poses = poses_.size();
  drive_covered(0, 1);
  look_round(1);
  EXPECT_THAT(health(), HasSubstr("mapping apart"));
  EXPECT_EQ(poses_.size(), poses) << "a piece has no pose in the map";
  EXPECT_EQ(keyframes_in(1), 0U);
  drive_to(at_door(1));
  drive_to({at_door(1).x_m, 0.0, 0.3});
  drive_to({at_door(0).x_m, 0.0, 0.3});
  drive_to(at_door(0));
  look_round(0);
  EXPECT_THAT(health(), Not(HasSubstr("apart")));
  EXPECT_FALSE(is_recorded());
  EXPECT_GE(keyframes_in(1), 2U);
  EXPECT_GT(poses_.size(), poses);
  expect_all_true();
}

TEST_F(LeavingMap, KeepsThePieceWhereItNeverComesBack) {
  map_room(0);
  drive_covered(0, 1);
  look_round(1);
  mapper_->service.stop();
  EXPECT_TRUE(is_recorded());
  EXPECT_EQ(keyframes_in(1), 0U);
  start_mapper();
  EXPECT_THAT(health(), HasSubstr("mapping apart"));
  expect_all_true();
}

TEST_F(LeavingMap, GoesOnWithThePieceOfAMapperThatDied) {
  map_room(0);
  drive_covered(0, 1);
  look_round(1);
  start_mapper();
  run(1.0);
  drive_to(at_door(1));
  drive_to({at_door(1).x_m, 0.0, 0.3});
  drive_to({at_door(0).x_m, 0.0, 0.3});
  drive_to(at_door(0));
  look_round(0);
  EXPECT_FALSE(is_recorded());
  EXPECT_FALSE(is_recorded("-1"));
  EXPECT_GE(keyframes_in(1), 2U);
  expect_all_true();
}

// Nothing hangs together with the map: both ways were covered.
TEST_F(LeavingMap, LeavesThePieceWhereNoCloudFitsBoth) {
  map_room(0);
  drive_covered(0, 1);
  look_round(1);
  drive_covered(1, 0);
  look_round(0);
  EXPECT_EQ(keyframes_in(1), 0U);
  EXPECT_TRUE(is_recorded("-1"));
  EXPECT_THAT(health(), HasSubstr("voxlist extend"));
  expect_all_true();
}

}  // namespace
}  // namespace voxlist::services
