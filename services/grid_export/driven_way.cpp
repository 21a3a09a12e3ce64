#include "services/grid_export/driven_way.h"

#include <algorithm>
#include <cmath>

#include "voxlist/bus/convert.h"

namespace voxlist::services {
namespace {

constexpr std::int64_t kAskPeriod_us = 1'000'000;

// Poses nearer to each other tell nothing new (m).
constexpr double kApart_m = 0.1;

// A place is so wide (m): within it the robot stands on the same columns, but for their rims.
constexpr double kPlace_m = 0.05;

// Most places that are kept; then poses are forgotten, for keyframes tell of the way.
constexpr std::size_t kMostPlaces = 200'000;

// Keyframes of a map; a word of more is no mapper's.
constexpr std::int64_t kMostKeyframes = 10'000'000;

Voxel place_of(const Eigen::Vector3d& at) {
  const auto number = [](double m) { return static_cast<std::int32_t>(std::floor(m / kPlace_m)); };
  return {number(at.x()), number(at.y()), number(at.z())};
}

}  // namespace

void DrivenWay::forget_poses() {
  poses_.clear();
  places_ = Numbering<Voxel>();
  newest_.reset();
  is_newest_kept_ = false;
}

void DrivenWay::follow(const Map& map) {
  if (map.map_id != map_.map_id || map.moves != map_.moves) {
    keyframes_.clear();
    forget_poses();
    first_missing_ = 0;
    asked_us_.reset();
  }
  map_ = map;
  keyframes_.resize(
      static_cast<std::size_t>(std::clamp(map.keyframes, std::int64_t{0}, kMostKeyframes)));
  first_missing_ = std::min(first_missing_, keyframes_.size());
}

bool DrivenWay::take(const keyframe_t& message) {
  const Eigen::Vector3d at(message.trans[0], message.trans[1], message.trans[2]);
  if (message.map_id != map_.map_id || message.index < 0 || !at.allFinite()) return false;
  const auto index = static_cast<std::size_t>(message.index);
  if (index >= keyframes_.size()) return false;
  const bool is_new = !keyframes_[index];
  keyframes_[index] = at;
  while (first_missing_ < keyframes_.size() && keyframes_[first_missing_]) ++first_missing_;
  // The rest of an answer follows: it is not asked for again.
  if (is_new && asked_us_) asked_us_ = now_us_;
  return is_new;
}

void DrivenWay::take(const pose_t& message) {
  pose_utime_us_ = message.utime;
  position_ = Eigen::Vector3d(message.pos[0], message.pos[1], message.pos[2]);
}

bool DrivenWay::take(const uncertain_pose_t& message) {
  const bool is_ours = message.utime == pose_utime_us_ && message.map_id == map_.map_id;
  if (!is_ours || !(position_.cwiseAbs().maxCoeff() <= bus::kMaxPosition_m)) return false;
  if (newest_ && (*newest_ - position_).norm() < kApart_m) return false;
  if (places_.size() >= kMostPlaces) forget_poses();
  const std::size_t known = places_.size();
  const bool is_new = places_.number(place_of(position_)) == known;
  if (is_new) {
    // After a way that was known a part begins where that ended: the robot came from there.
    if (!is_newest_kept_) poses_.emplace_back();
    if (!is_newest_kept_ && newest_) poses_.back().push_back(*newest_);
    poses_.back().push_back(position_);
  }
  newest_ = position_;
  is_newest_kept_ = is_new;
  return is_new;
}

std::optional<std::int32_t> DrivenWay::due(std::int64_t now_us) {
  now_us_ = now_us;
  if (first_missing_ == keyframes_.size()) return std::nullopt;
  if (asked_us_ && now_us - *asked_us_ < kAskPeriod_us) return std::nullopt;
  asked_us_ = now_us;
  return static_cast<std::int32_t>(first_missing_);
}

std::vector<Eigen::Vector3d> DrivenWay::keyframes() const {
  std::vector<Eigen::Vector3d> way;
  for (const auto& keyframe : keyframes_)
    if (keyframe) way.push_back(*keyframe);
  return way;
}

}  // namespace voxlist::services
