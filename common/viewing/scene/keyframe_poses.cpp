#include "voxlist/viewing/scene/keyframe_poses.h"

#include <algorithm>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/bus/convert.h"

namespace voxlist::viewing {
namespace {

// What is farther from a keyframe (m) is no part of what it saw; rooms are some metres wide.
constexpr double kNear_m = 5.0;

// Poses that differ by less (relative) are the same.
constexpr double kSame = 1e-9;

constexpr std::int64_t kAskPeriod_us = 1'000'000;

// Keyframes of a map; a word of more is no mapper's.
constexpr std::int64_t kMostKeyframes = 10'000'000;

std::optional<Pose3> pose_of(const keyframe_t& message) {
  pose_t same{};
  same.utime = message.utime;
  std::ranges::copy(message.trans, same.pos);
  std::ranges::copy(message.quat, same.orientation);
  const auto pose = bus::from_message(same);
  if (!pose) return std::nullopt;
  return pose->pose;
}

}  // namespace

void KeyframePoses::follow(const Map& map) {
  if (map.map_id != map_.map_id) keyframes_.clear();
  if (map.moves != map_.moves) asked_us_.reset();
  map_ = map;
  keyframes_.resize(
      static_cast<std::size_t>(std::clamp(map.keyframes, std::int64_t{0}, kMostKeyframes)));
}

// KEYFRAME may overtake the MAP_UPDATE that it belongs to: the map is a keyframe larger then.
std::optional<std::size_t> KeyframePoses::take(const keyframe_t& message) {
  const auto index = static_cast<std::size_t>(std::max(message.index, 0));
  if (message.map_id != map_.map_id || message.index < 0 || index > keyframes_.size())
    return std::nullopt;
  const auto T_map_base = pose_of(message);
  if (!T_map_base) return std::nullopt;
  if (index == keyframes_.size()) keyframes_.emplace_back();
  Keyframe& keyframe = keyframes_[index];
  const bool is_same = keyframe.T_map_base && keyframe.T_map_base->isApprox(*T_map_base, kSame);
  keyframe.T_map_base = T_map_base;
  keyframe.moves = map_.moves;
  // The rest of an answer follows: it is not asked for again.
  if (asked_us_) asked_us_ = now_us_;
  if (is_same) return std::nullopt;
  return index;
}

std::optional<std::size_t> KeyframePoses::near(const Eigen::Vector3d& position) {
  for (std::size_t i = keyframes_.size(); i-- > 0;) {
    Keyframe& keyframe = keyframes_[i];
    if (!keyframe.T_map_base || keyframe.moves != map_.moves) continue;
    if ((keyframe.T_map_base->translation() - position).norm() > kNear_m) continue;
    keyframe.is_named = true;
    return i;
  }
  return std::nullopt;
}

std::optional<std::int32_t> KeyframePoses::due(std::int64_t now_us) {
  now_us_ = now_us;
  if (asked_us_ && now_us - *asked_us_ < kAskPeriod_us) return std::nullopt;
  const auto missing = std::ranges::find_if(
      keyframes_, [&](const Keyframe& k) { return k.is_named && k.moves != map_.moves; });
  if (missing == keyframes_.end()) return std::nullopt;
  asked_us_ = now_us;
  return static_cast<std::int32_t>(missing - keyframes_.begin());
}

}  // namespace voxlist::viewing
