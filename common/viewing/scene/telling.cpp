#include "voxlist/viewing/scene/telling.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <voxlist/health_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/traversability_t.hpp>
#include <voxlist/uncertain_pose_t.hpp>

namespace voxlist::viewing {
namespace {

using nlohmann::json;

// Text from the bus may be no UTF-8; numbers that are not finite become null.
std::string text_of(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

json json_of_mode(const pose_mode_t& mode) {
  return {{"pose", mode.pose},
          {"covariance", mode.covariance},
          {"probability", mode.probability},
          {"overlap", mode.overlap}};
}

// A forged LOCALISATION may have any number of them.
constexpr std::size_t kMostModes = 50;

const char* name_of_edit(EditKind kind) {
  switch (kind) {
    case EditKind::kErase:
      return "erase";
    case EditKind::kKeepFree:
      return "free";
    case EditKind::kKeepBlocked:
      return "blocked";
  }
  return "";
}

json corner(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

// -1: nothing is there.
std::vector<int> centimetres(const std::vector<float>& metres) {
  std::vector<int> result;
  for (const float m : metres)
    result.push_back(std::isfinite(m) && std::abs(m) < 1e4F ? static_cast<int>(100.0F * m) : -1);
  return result;
}

}  // namespace

const char* name_of_state(std::int32_t state) {
  switch (state) {
    case localisation_t::STATE_TRACKING:
      return "TRACKING";
    case localisation_t::STATE_AMBIGUOUS:
      return "AMBIGUOUS";
    default:
      return "LOST";
  }
}

bool is_topic_name(const std::string& text) {
  const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  return !text.empty() && text.size() <= 40 && std::ranges::all_of(text, fits);
}

std::string why_lost(const localisation_t& message) {
  if (message.map_version == 0) return "there is no map yet";
  if (message.modes.empty()) return "nothing in the map fits what the robot sees";
  double sum = 0.0;
  for (const pose_mode_t& mode : message.modes) sum += mode.probability;
  const auto percent = std::to_string(static_cast<int>(std::lround(100.0 * std::min(sum, 1.0))));
  return "the map may not know this place: all candidates together have " + percent + " %";
}

std::string json_of(const localisation_t& message, std::int64_t since_us) {
  json modes = json::array();
  for (const pose_mode_t& mode : message.modes)
    if (modes.size() < kMostModes) modes.push_back(json_of_mode(mode));
  const bool is_lost = message.state == localisation_t::STATE_LOST;
  return text_of({{"utime_us", message.utime},
                  {"map_version", message.map_version},
                  {"state", name_of_state(message.state)},
                  {"for_s", 1e-6 * static_cast<double>(message.utime - since_us)},
                  {"why", is_lost ? why_lost(message) : ""},
                  {"confidence", message.confidence},
                  {"certified", message.certified != 0},
                  {"elapsed_ms", 1e-3 * message.elapsed_us},
                  {"jump", message.jump},
                  {"modes", modes}});
}

std::string json_of(const StampedPose3& T_map_base) {
  return text_of({{"utime_us", T_map_base.utime_us},
                  {"position", corner(T_map_base.pose.translation())},
                  {"yaw", to_pose2(T_map_base.pose).yaw_rad}});
}

std::string json_of(const uncertain_pose_t& message) {
  return text_of({{"utime_us", message.utime},
                  {"cloud_utime_us", message.cloud_utime},
                  {"covariance", message.covariance}});
}

std::string json_of(const health_t& message) {
  static constexpr const char* kStates[] = {"OK", "WARNING", "ERROR"};
  const int state = std::clamp(message.state, 0, 2);
  return text_of({{"service", message.service},
                  {"state", kStates[state]},
                  {"message", message.message},
                  {"p99_ms", message.latency_p99_ms},
                  {"pid", message.pid},
                  {"utime_us", message.utime}});
}

std::string json_of(const obstacles_t& message) {
  json moving = json::array();
  for (const moving_obstacle_t& m : message.moving)
    moving.push_back({m.position[0], m.position[1], m.velocity[0], m.velocity[1], m.radius_m});
  json nearest = json::array();
  for (const std::vector<float>& row : message.nearest_m) nearest.push_back(centimetres(row));
  return text_of({{"utime_us", message.utime},
                  {"blind", message.blind},
                  {"rad0", message.rad0},
                  {"radstep", message.radstep},
                  {"nearest_cm", nearest},
                  {"ground_cm", centimetres(message.ground_seen_to_m)},
                  {"moving", moving}});
}

std::string json_of(const traversability_t& message) {
  return text_of({{"utime_us", message.utime},
                  {"xy0", message.xy0},
                  {"cell_m", message.resolution_m},
                  {"size", message.dimensions},
                  {"compressed", message.compressed != 0}});
}

std::string json_of(const bus::EditedBoxes& edits) {
  json boxes = json::array();
  for (std::size_t i = 0; i < edits.boxes.size(); ++i) {
    const PlacedBox& b = edits.boxes[i];
    boxes.push_back({{"id", edits.ids[i]},
                     {"kind", name_of_edit(b.kind)},
                     {"lowest", corner(b.box.min())},
                     {"highest", corner(b.box.max())},
                     {"placed", {b.T_map_box.x_m, b.T_map_box.y_m, b.T_map_box.yaw_rad}}});
  }
  return text_of({{"map_id", std::to_string(edits.map_id)}, {"boxes", boxes}});
}

std::vector<std::uint8_t> points_of(const pointcloud_t& message, std::size_t most) {
  constexpr float kReach_m = 300.0F;
  const std::size_t step = std::max<std::size_t>(1, (message.points.size() + most - 1) / most);
  std::vector<std::int16_t> values;
  for (std::size_t i = 0; i < message.points.size(); i += step) {
    const auto& p = message.points[i];
    if (!std::ranges::all_of(p, [](float v) { return std::abs(v) < kReach_m; })) continue;
    for (const float v : p) values.push_back(static_cast<std::int16_t>(std::lround(100.0F * v)));
  }
  std::vector<std::uint8_t> bytes(values.size() * sizeof(std::int16_t));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

}  // namespace voxlist::viewing
