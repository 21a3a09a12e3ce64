#include "voxlist/foreign/foxglove/converter.h"

#include <voxlist/health_t.hpp>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pixel_map_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>
#include <voxlist/rigid_transform_t.hpp>
#include <voxlist/traversability_t.hpp>

#include "voxlist/bus/channels.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/maps/map_faults.h"
#include "voxlist/foreign/foxglove/scene_messages.h"

namespace voxlist::foreign {
namespace {

const Topic kMap{"/map", Kind::kPointCloud}, kPath{"/path", Kind::kPointCloud},
    kCloud{"/cloud", Kind::kPointCloud}, kCloudSlice{"/cloud_slice", Kind::kPointCloud},
    kSpace{"/free_space", Kind::kPointCloud}, kMovers{"/moving_obstacles", Kind::kSceneUpdate},
    kObstacles{"/obstacles", Kind::kPointCloud}, kCandidates{"/candidates", Kind::kPosesInFrame},
    kCandidatePoints{"/candidate_points", Kind::kPointCloud}, kPose{"/pose", Kind::kPoseInFrame},
    kOdometry{"/odometry", Kind::kPoseInFrame}, kTruth{"/truth", Kind::kPoseInFrame},
    kTransforms{"/tf", Kind::kFrameTransform}, kLocalisation{"/localisation", Kind::kLog},
    kHealth{"/health", Kind::kLog};

constexpr std::string_view kGridPrefix = "GRID_", kTypesPrefix = "TRAVERSABILITY_",
                           kScanPrefix = "SCAN_", kFarScanPrefix = "SCAN_FAR_";

// Points of the path are this far apart (m), and at most so many: 100 km.
constexpr double kPathStep_m = 0.1;
constexpr std::size_t kMostPathBytes = 12'000'000;

// A service says again that nothing has changed this often (us).
constexpr std::int64_t kSayAgain_us = 10'000'000;

// Services that are remembered: their names come from messages.
constexpr std::size_t kMostServices = 1000;

std::string after(std::string_view prefix, const std::string& channel) {
  return ascii(channel.substr(prefix.size()));
}

}  // namespace

Converter::Converter(Audience& audience, const ConverterConfig& config)
    : audience_(audience),
      map_(config.map_detail_m),
      map_retelling_(config.retelling),
      path_retelling_(config.retelling),
      space_retelling_(config.retelling),
      path_{point_fields(), {}} {}

template <class M>
void Converter::decode(const std::string& channel, bus::Bytes bytes) {
  M message{};
  const bus::Fault fault = bus::decode(bytes, message);
  if (fault == bus::Fault::kNone) return take(channel, message);
  ++faults_[channel + "/" + bus::fault_name(fault)];
}

void Converter::take(const std::string& channel, bus::Bytes bytes) {
  using Decode = void (Converter::*)(const std::string&, bus::Bytes);
  static const std::map<std::string, Decode> kKnown{
      {bus::kCloud.name, &Converter::decode<pointcloud_t>},
      {bus::kCloudSlice.name, &Converter::decode<pointcloud_t>},
      {bus::kPose.name, &Converter::decode<pose_t>},
      {bus::kOdometry.name, &Converter::decode<pose_t>},
      {bus::kTruth.name, &Converter::decode<pose_t>},
      {bus::kMapOdom.name, &Converter::decode<rigid_transform_t>},
      {bus::kLocalisation.name, &Converter::decode<localisation_t>},
      {bus::kMapUpdate.name, &Converter::decode<map_update_t>},
      {bus::kFreeSpace.name, &Converter::decode<map_update_t>},
      {bus::kKeyframe.name, &Converter::decode<keyframe_t>},
      {bus::kObstacles.name, &Converter::decode<obstacles_t>},
      {bus::kHealth.name, &Converter::decode<health_t>}};
  if (channel.starts_with(kGridPrefix)) return decode<pixel_map_t>(channel, bytes);
  if (channel.starts_with(kTypesPrefix)) return decode<traversability_t>(channel, bytes);
  if (channel.starts_with(kScanPrefix)) return decode<planar_lidar_t>(channel, bytes);
  const auto known = kKnown.find(channel);
  if (known != kKnown.end()) (this->*known->second)(channel, bytes);
}

void Converter::tell(const Topic& topic, std::int64_t utime_us, std::optional<std::string> message,
                     const std::string& channel) {
  if (message) return audience_.tell(topic, utime_us, std::move(*message));
  ++faults_[channel + "/senseless"];
}

void Converter::take(const std::string& channel, const pointcloud_t& message) {
  const Topic& topic = channel == bus::kCloud.name ? kCloud : kCloudSlice;
  if (!audience_.wants(topic)) return;
  const bus::ReceivedCloud received = bus::from_message(message);
  if (received.cloud) return tell(topic, message.utime, cloud_message(*received.cloud), channel);
  ++faults_[channel + "/" + received.refusal];
}

void Converter::take(const std::string& channel, const pose_t& message) {
  const auto pose = bus::from_message(message);
  if (!pose) return tell(kPose, 0, std::nullopt, channel);
  const bool is_odometry = channel == bus::kOdometry.name, is_pose = channel == bus::kPose.name;
  const Stamp stamp{message.utime, is_odometry ? kOdomFrame : kMapFrame};
  const Topic& topic = is_odometry ? kOdometry : is_pose ? kPose : kTruth;
  if (audience_.wants(topic)) tell(topic, message.utime, pose_in_frame(stamp, pose->pose), channel);
  if (is_pose) follow(message.utime, pose->pose);
}

void Converter::follow(std::int64_t utime_us, const Pose3& T_map_base) {
  if (audience_.wants(kTransforms))
    audience_.tell(kTransforms, utime_us,
                   frame_transform({utime_us, kMapFrame}, kBaseFrame, T_map_base));
  const Eigen::Vector3d at = T_map_base.translation();
  const bool is_new = !path_end_ || (at - *path_end_).norm() >= kPathStep_m;
  if (!is_new || path_.data.size() >= kMostPathBytes) return;
  path_end_ = at;
  path_utime_us_ = utime_us;
  pack(at, path_);
  path_retelling_.add(1);
  tick(utime_us);
}

void Converter::take(const std::string& channel, const rigid_transform_t& message) {
  const auto T_map_odom = transform_of(message);
  if (!T_map_odom) return tell(kTransforms, 0, std::nullopt, channel);
  tell(kTransforms, message.utime,
       frame_transform({message.utime, kMapFrame}, kOdomFrame, T_map_odom->pose), channel);
}

void Converter::take(const std::string& channel, const localisation_t& message) {
  tell(kCandidates, message.utime, candidates_message(message), channel);
  const auto points = candidate_points_message(message);
  if (!points) return;
  tell(kCandidatePoints, message.utime, points, channel);
  if (message.state != state_) tell(kLocalisation, message.utime, state_message(message), channel);
  state_ = message.state;
}

void Converter::take(const std::string& channel, const obstacles_t& message) {
  if (audience_.wants(kObstacles))
    tell(kObstacles, message.utime, obstacles_message(message), channel);
  if (audience_.wants(kMovers)) tell(kMovers, message.utime, movers_message(message), channel);
}

void Converter::take(const std::string& channel, const planar_lidar_t& message) {
  const bool is_far = channel.starts_with(kFarScanPrefix);
  const std::string name = is_far ? "/scan_far/" + after(kFarScanPrefix, channel)
                                  : "/scan/" + after(kScanPrefix, channel);
  const Topic topic{name, Kind::kLaserScan};
  if (audience_.wants(topic)) tell(topic, message.utime, scan_message(message), channel);
}

void Converter::take(const std::string& channel, const pixel_map_t& message) {
  const Topic topic{"/grid/" + after(kGridPrefix, channel), Kind::kGrid};
  tell(topic, message.utime, grid_message(message), channel);
}

void Converter::take(const std::string& channel, const traversability_t& message) {
  const Topic topic{"/traversability/" + after(kTypesPrefix, channel), Kind::kGrid};
  tell(topic, message.utime, grid_message(message), channel);
}

void Converter::take(const std::string& channel, const health_t& message) {
  if (!bus::is_sane_utime(message.utime)) return tell(kHealth, 0, std::nullopt, channel);
  if (said_.size() > kMostServices) said_.clear();
  Said& said = said_[message.service];
  const bool is_same = said.state == message.state && said.sentence == message.message;
  if (is_same && message.utime - said.utime_us < kSayAgain_us) return;
  said = {message.utime, message.state, message.message};
  tell(kHealth, message.utime, health_message(message), channel);
}

void Converter::take(const std::string& channel, const keyframe_t& message) {
  const auto keyframe = bus::from_message(message);
  if (!keyframe) return tell(kMap, 0, std::nullopt, channel);
  map_retelling_.add(map_.add(*keyframe));
  tick(message.utime);
}

void Converter::take(const std::string& channel, const map_update_t& message) {
  const bus::MapFault fault = bus::fault_of(message);
  if (fault != bus::MapFault::kNone) {
    ++faults_[channel + "/" + bus::name(fault)];
    return;
  }
  if (channel == bus::kFreeSpace.name) {
    for (const bus::MapChange& change : space_assembler_.add(message)) take_space(change);
  } else {
    for (const bus::MapChange& change : assembler_.add(message)) take(change);
  }
}

bool Converter::wants_space() { return audience_.wants(kSpace); }

void Converter::take_space(const bus::MapChange& change) {
  space_retelling_.add(space_.apply(change));
  tick(change.utime_us);
}

void Converter::take(const bus::MapChange& change) {
  // Before the first map there was none, of which 0 is the id.
  if (map_.map_id() != 0 && change.map_id != map_.map_id()) {
    path_.data.clear();
    path_end_.reset();
  }
  map_retelling_.add(map_.apply(change));
  tick(change.utime_us);
}

void Converter::tick(std::int64_t utime_us) {
  if (map_retelling_.is_due(map_.blocks(), utime_us) && audience_.wants(kMap)) tell_map(utime_us);
  const std::size_t points = path_.data.size() / stride_of(path_.fields);
  if (path_retelling_.is_due(points, utime_us) && audience_.wants(kPath)) tell_path(utime_us);
  if (space_retelling_.is_due(space_.blocks(), utime_us) && wants_space()) tell_space(utime_us);
}

void Converter::tell_map(std::int64_t now_us) {
  audience_.tell(kMap, map_.utime_us(), point_cloud({map_.utime_us(), kMapFrame}, map_.points()));
  map_retelling_.told(now_us);
}

void Converter::tell_path(std::int64_t utime_us) {
  audience_.tell(kPath, utime_us, point_cloud({utime_us, kMapFrame}, path_));
  path_retelling_.told(utime_us);
}

void Converter::tell_space(std::int64_t now_us) {
  const Stamp stamp{space_.utime_us(), kMapFrame};
  audience_.tell(kSpace, stamp.utime_us, point_cloud(stamp, space_.points()));
  space_retelling_.told(now_us);
}

void Converter::tell_rest() {
  if (space_retelling_.is_new()) tell_space(space_.utime_us());
  if (map_retelling_.is_new()) tell_map(map_.utime_us());
  if (path_retelling_.is_new()) tell_path(path_utime_us_);
}

}  // namespace voxlist::foreign
