#include "voxlist/viewing/scene/other_robots.h"

#include <fmt/core.h>

#include <numbers>
#include <voxlist/localisation_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/bus/convert.h"
#include "voxlist/viewing/scene/board.h"
#include "voxlist/viewing/scene/telling.h"

namespace voxlist::viewing {

const std::vector<std::string> OtherRobots::kChannels = {"*/POSE", "*/LOCALISATION"};

OtherRobots::OtherRobots(const std::vector<OtherRobotPlace>& places) {
  for (const OtherRobotPlace& place : places)
    places_[place.name] = {place.x_m, place.y_m, place.yaw_deg * std::numbers::pi / 180.0};
}

bus::Fault OtherRobots::take(const std::string& channel, bus::Bytes bytes,
                             std::optional<std::int64_t> map_id, std::int64_t now_us,
                             Board& board) {
  const std::size_t slash = channel.find('/');
  const std::string name = channel.substr(0, slash);
  if (slash == std::string::npos || !is_topic_name(name)) return bus::Fault::kBadText;
  if (robots_.size() >= kMostRobots && !robots_.contains(name)) return bus::Fault::kTooLarge;
  return channel.substr(slash) == "/POSE" ? take_pose(name, bytes, map_id, now_us, board)
                                          : take_state(name, bytes);
}

bus::Fault OtherRobots::take_state(const std::string& name, bus::Bytes bytes) {
  localisation_t message{};
  if (const bus::Fault fault = bus::decode(bytes, message); fault != bus::Fault::kNone)
    return fault;
  robots_[name] = {name_of_state(message.state), message.map_id};
  return bus::Fault::kNone;
}

bus::Fault OtherRobots::take_pose(const std::string& name, bus::Bytes bytes,
                                  std::optional<std::int64_t> map_id, std::int64_t now_us,
                                  Board& board) {
  pose_t message{};
  if (const bus::Fault fault = bus::decode(bytes, message); fault != bus::Fault::kNone)
    return fault;
  const auto pose = bus::from_message(message);
  if (!pose) return bus::Fault::kCodecFailed;
  const std::string& state = robots_[name].state;
  const auto frame = T_map_other(name, map_id);
  const Pose2 flat = frame.value_or(Pose2{}) * to_pose2(pose->pose);
  board.put(
      "service/robot " + name,
      fmt::format("{{\"service\":\"robot {}\",\"state\":\"{}\",\"message\":\"{} at {:.1f}, {:.1f} "
                  "m{}\",\"p99_ms\":-1,\"pid\":0}}",
                  name, state == "TRACKING" ? "OK" : "WARNING", state, flat.x_m, flat.y_m,
                  frame ? "" : " in a map of its own"),
      now_us);
  const std::string place = frame ? fmt::format("[{:.4f},{:.4f},{:.4f},{:.5f}]", flat.x_m, flat.y_m,
                                                pose->pose.translation().z(), flat.yaw_rad)
                                  : "null";
  board.put(
      "other/" + name,
      fmt::format("{{\"utime_us\":{},\"state\":\"{}\",\"pose\":{}}}", pose->utime_us, state, place),
      now_us);
  return bus::Fault::kNone;
}

std::optional<Pose2> OtherRobots::T_map_other(const std::string& name,
                                              std::optional<std::int64_t> map_id) const {
  if (const auto place = places_.find(name); place != places_.end()) return place->second;
  const auto robot = robots_.find(name);
  const bool is_same = map_id && robot != robots_.end() && robot->second.map_id == map_id;
  return is_same ? std::optional(Pose2{}) : std::nullopt;
}

}  // namespace voxlist::viewing
