#include "services/voxlist/view/events.h"

#include <utility>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/bus/convert.h"
#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::desk {
namespace {

constexpr std::int64_t kMapId = 1;

bus::MapChange whole_map(const OccupancyMap& map, std::int64_t utime_us) {
  bus::MapChange change;
  change.utime_us = utime_us;
  change.map_id = kMapId;
  change.version = 1;
  change.resolution = bus::resolution_of(map);
  change.blocks = bus::to_messages(map);
  return change;
}

}  // namespace

LogEvents::LogEvents(std::string path, std::string prefix)
    : path_(std::move(path)), prefix_(std::move(prefix)), reader_(path_) {}

std::optional<bus::Event> LogEvents::next() {
  while (auto event = reader_.next()) {
    if (!event->channel.starts_with(prefix_)) continue;
    event->channel.erase(0, prefix_.size());
    return event;
  }
  return std::nullopt;
}

MapEvents::MapEvents(const OccupancyMap& map, const OccupancyMap& free_space,
                     const std::vector<StampedPose3>& poses) {
  const std::int64_t begin_us = poses.front().utime_us;
  add_map(bus::kMapUpdate, {map.occupied, VoxelMap(map.passed.resolution_m())}, begin_us);
  if (!free_space.passed.empty()) add_map(bus::kFreeSpace, free_space, begin_us);
  for (const StampedPose3& pose : poses) add_pose(pose);
}

void MapEvents::add_map(bus::Channel<map_update_t> channel, const OccupancyMap& map,
                        std::int64_t utime_us) {
  for (const map_update_t& message : bus::split_map(whole_map(map, utime_us)))
    add(channel, utime_us, message);
}

void MapEvents::add_pose(const StampedPose3& pose) {
  const Pose2 planar = to_pose2(pose.pose);
  localisation_t found{};
  found.utime = pose.utime_us;
  found.map_id = kMapId;
  found.map_version = 1;
  found.state = localisation_t::STATE_TRACKING;
  found.confidence = 1.0;
  found.n_modes = 1;
  found.modes.resize(1);
  found.modes[0].pose[0] = planar.x_m;
  found.modes[0].pose[1] = planar.y_m;
  found.modes[0].pose[2] = planar.yaw_rad;
  found.modes[0].probability = 1.0;
  add(bus::kLocalisation, pose.utime_us, found);
  add(bus::kPose, pose.utime_us, bus::to_message(pose));
}

template <class M>
void MapEvents::add(bus::Channel<M> channel, std::int64_t utime_us, const M& message) {
  std::vector<std::uint8_t> bytes;
  if (bus::encode(message, bytes) != bus::Fault::kNone) return;
  events_.push_back({static_cast<std::int64_t>(events_.size()), utime_us, channel.name, bytes});
}

std::optional<bus::Event> MapEvents::next() {
  if (next_ == events_.size()) return std::nullopt;
  return events_[next_++];
}

}  // namespace voxlist::desk
