#include "voxlist/viewing/scene/robot_scene.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <voxlist/health_t.hpp>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_octree_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>
#include <voxlist/traversability_t.hpp>
#include <voxlist/uncertain_pose_t.hpp>

#include "voxlist/bus/convert.h"
#include "voxlist/viewing/scene/telling.h"

namespace voxlist::viewing {
namespace {

// A slice is drawn at the newest POSE where that is no older than this (us).
constexpr std::int64_t kPoseAge_us = 300'000;

// Cells along an edge of a grid that a page can show.
constexpr std::int32_t kMostCells = 16'384;

// Slices that a page has at once: a second of them.
constexpr std::int64_t kSlices = 16;

// `height_m` and yaw: of base in the map.
std::string placed(std::int64_t utime_us, double x_m, double y_m, double height_m, double yaw_rad) {
  return fmt::format("{{\"utime_us\":{},\"pose\":[{:.4f},{:.4f},{:.4f},{:.5f}]}}", utime_us, x_m,
                     y_m, height_m, yaw_rad);
}

}  // namespace

void RobotScene::take(const localisation_t& message, std::int64_t now_us) {
  if (std::exchange(state_, message.state) != message.state) since_us_ = message.utime;
  if (message.state != localisation_t::STATE_TRACKING) travelled_.interrupt();
  map_id_ = message.map_id;
  board_.put("robot", json_of(message, since_us_), now_us);
  place_cloud(message, now_us);
}

void RobotScene::place_cloud(const localisation_t& message, std::int64_t now_us) {
  if (!cloud_ || cloud_->utime_us != message.utime) return;
  const WaitingCloud cloud = *std::exchange(cloud_, std::nullopt);
  if (message.state != localisation_t::STATE_TRACKING || message.modes.empty()) return;
  const pose_mode_t& mode = message.modes.front();
  board_.put("cloud",
             placed(cloud.utime_us, mode.pose[0], mode.pose[1], mode.tilt[0], mode.pose[2]), now_us,
             cloud.points);
}

void RobotScene::take(const pose_t& message, std::int64_t now_us) {
  const auto pose = bus::from_message(message);
  if (!pose) return;
  pose_ = {pose->utime_us, pose->pose.translation(), to_pose2(pose->pose).yaw_rad};
  board_.put("pose", json_of(*pose), now_us);
  travelled_.add(pose_->position, keyframes_, now_us, board_);
}

bus::Fault RobotScene::take_other(const std::string& channel, bus::Bytes bytes,
                                  std::int64_t now_us) {
  return others_.take(channel, bytes, map_id_, now_us, board_);
}

void RobotScene::take(const keyframe_t& message, std::int64_t now_us) {
  if (const auto moved = keyframes_.take(message))
    travelled_.move(*moved, keyframes_.pose(*moved), now_us, board_);
}

void RobotScene::take(const uncertain_pose_t& message, std::int64_t now_us) {
  board_.put("sigma", json_of(message), now_us);
}

void RobotScene::take(const obstacles_t& message, std::int64_t now_us) {
  board_.put("obstacles", json_of(message), now_us);
}

void RobotScene::take(const health_t& message, std::int64_t now_us) {
  if (!is_topic_name(message.service)) return;
  board_.put("service/" + message.service, json_of(message), now_us);
}

void RobotScene::take(const bus::EditedBoxes& edits, std::int64_t now_us) {
  knows_edits_ = true;
  board_.put("edits", json_of(edits), now_us);
}

void RobotScene::take(const map_octree_t& message, std::int64_t now_us) {
  board_.put("octomap",
             fmt::format("{{\"utime_us\":{},\"keyframes\":{},\"bytes\":{}}}", message.utime,
                         message.view_id, message.num_bytes),
             now_us);
}

void RobotScene::take(const traversability_t& message, std::int64_t now_us) {
  const auto fits = [](std::int32_t cells) { return cells > 0 && cells <= kMostCells; };
  if (!is_topic_name(message.profile) || !std::ranges::all_of(message.dimensions, fits)) return;
  board_.put("grid/" + message.profile, json_of(message), now_us, message.cells);
}

void RobotScene::take_cloud(const pointcloud_t& message, std::int64_t) {
  cloud_ = {message.utime, points_of(message, most_points_)};
}

void RobotScene::take_slice(const pointcloud_t& message, std::int64_t now_us) {
  if (!pose_ || std::abs(message.utime - pose_->utime_us) > kPoseAge_us) return;
  const auto& p = pose_->position;
  board_.put(fmt::format("slice/{}", slices_++ % kSlices),
             placed(message.utime, p.x(), p.y(), p.z(), pose_->yaw_rad), now_us,
             points_of(message, most_points_ / kSlices + 1));
}

void RobotScene::take(const bus::MapChange& change, std::int64_t now_us) {
  keyframes_.follow({change.map_id, change.moves, change.version - change.moves - change.edits});
  const bool is_new = change.moves > moves_ && pose_;
  moves_ = change.moves;
  if (!is_new) return;
  const Pose2& moved = change.T_new_old;
  board_.put("loop",
             fmt::format("{{\"utime_us\":{},\"loops\":{},\"moved\":[{:.3f},{:.3f},{:.4f}],"
                         "\"at\":[{:.3f},{:.3f},{:.3f}]}}",
                         change.utime_us, change.moves, moved.x_m, moved.y_m, moved.yaw_rad,
                         pose_->position.x(), pose_->position.y(), pose_->position.z()),
             now_us);
  travelled_.interrupt();
}

void RobotScene::clear() {
  board_.drop_all_but("hello");
  others_.clear();
  map_id_.reset();
  start_over(0);
  state_ = -1;
}

void RobotScene::start_over(std::int64_t now_us) {
  travelled_.start_over(now_us, board_);
  pose_.reset();
  cloud_.reset();
  keyframes_ = {};
  moves_ = 0;
  knows_edits_ = false;
}

}  // namespace voxlist::viewing
