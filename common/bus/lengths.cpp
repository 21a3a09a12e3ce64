// check_lengths(): the sender's side of wire.h.
#include <voxlist/health_t.hpp>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_edit_t.hpp>
#include <voxlist/map_edits_t.hpp>
#include <voxlist/map_octree_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pixel_map_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_hint_t.hpp>
#include <voxlist/pose_t.hpp>
#include <voxlist/rigid_transform_t.hpp>
#include <voxlist/traversability_t.hpp>
#include <voxlist/uncertain_pose_t.hpp>

#include "voxlist/bus/wire.h"

namespace voxlist::bus {
namespace {

// Adds up what the arrays will take, and keeps the first fault.
class Lengths {
 public:
  template <class T>
  Lengths& array(std::int64_t count, const std::vector<T>& elements, std::int64_t bytes_each) {
    if (count != std::ssize(elements)) fail(Fault::kBadLength);
    return add(std::ssize(elements) * bytes_each);
  }

  Lengths& rows(std::int64_t count, const std::vector<std::vector<float>>& rows,
                std::int64_t columns) {
    array(count, rows, columns * 4);
    for (const auto& row : rows) {
      if (std::ssize(row) != columns) fail(Fault::kBadLength);
    }
    return *this;
  }

  Lengths& text(const std::string& text) {
    if (text.find('\0') != std::string::npos) fail(Fault::kBadText);
    return add(std::ssize(text) + 5);
  }

  Fault fault() const { return fault_; }

 private:
  Lengths& add(std::int64_t bytes) {
    bytes_ += bytes;
    if (bytes_ > kMaxMessageBytes - kFixedFields) fail(Fault::kTooLarge);
    return *this;
  }

  void fail(Fault fault) {
    if (fault_ == Fault::kNone) fault_ = fault;
  }

  // Bytes that a message's fields of fixed size may have: more than any type's.
  static constexpr std::int64_t kFixedFields = 1000;

  std::int64_t bytes_ = 0;
  Fault fault_ = Fault::kNone;
};

}  // namespace

Fault check_lengths(const health_t& message) {
  Lengths lengths;
  lengths.text(message.service)
      .text(message.version)
      .text(message.message)
      .array(message.n_counters, message.counters, 8)
      .array(message.n_gauges, message.gauges, 8);
  for (const counter_t& counter : message.counters) lengths.text(counter.name);
  for (const gauge_t& gauge : message.gauges) lengths.text(gauge.name);
  return lengths.fault();
}

Fault check_lengths(const keyframe_t& message) {
  return Lengths()
      .rows(message.n_points, message.points, 3)
      .rows(message.n_origins, message.origins, 3)
      .fault();
}

Fault check_lengths(const localisation_t& message) {
  return Lengths().array(message.n_modes, message.modes, 112).fault();
}

Fault check_lengths(const map_edit_t&) { return Fault::kNone; }

Fault check_lengths(const map_edits_t& message) {
  return Lengths().text(message.refusal).array(message.n_boxes, message.boxes, 84).fault();
}

Fault check_lengths(const map_octree_t& message) {
  return Lengths().array(message.num_bytes, message.data, 1).fault();
}

Fault check_lengths(const map_request_t&) { return Fault::kNone; }

Fault check_lengths(const map_update_t& message) {
  return Lengths()
      .array(message.n_blocks, message.blocks, 76)
      .array(message.n_passed_blocks, message.passed_blocks, 76)
      .fault();
}

Fault check_lengths(const mirror_state_t& message) {
  return Lengths().text(message.reason).fault();
}

Fault check_lengths(const obstacles_t& message) {
  Lengths lengths;
  lengths.text(message.blind)
      .array(message.n_bearings, message.ground_seen_to_m, 4)
      .rows(message.n_cells, message.cells, 2)
      .array(message.n_cells, message.types, 4)
      .array(message.n_moving, message.moving, 20);
  lengths.array(3, message.nearest_m, 0);
  for (const auto& nearest_m : message.nearest_m) lengths.array(message.n_bearings, nearest_m, 4);
  return lengths.fault();
}

Fault check_lengths(const pixel_map_t& message) {
  return Lengths().array(message.datasize, message.mapData, 1).fault();
}

Fault check_lengths(const planar_lidar_t& message) {
  return Lengths()
      .array(message.nranges, message.ranges, 4)
      .array(message.nintensities, message.intensities, 4)
      .fault();
}

Fault check_lengths(const pointcloud_t& message) {
  if (message.n_channels > kMaxCloudChannels) return Fault::kTooLarge;
  Lengths lengths;
  lengths.text(message.frame_id)
      .rows(message.n_points, message.points, 3)
      .array(message.n_channels, message.channel_names, 0)
      .rows(message.n_channels, message.channels, message.n_points);
  for (const std::string& channel : message.channel_names) lengths.text(channel);
  return lengths.fault();
}

Fault check_lengths(const pose_hint_t&) { return Fault::kNone; }

Fault check_lengths(const pose_t&) { return Fault::kNone; }

Fault check_lengths(const rigid_transform_t&) { return Fault::kNone; }

Fault check_lengths(const traversability_t& message) {
  return Lengths().text(message.profile).array(message.datasize, message.cells, 1).fault();
}

Fault check_lengths(const uncertain_pose_t&) { return Fault::kNone; }

}  // namespace voxlist::bus
