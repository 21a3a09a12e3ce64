#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>
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

namespace voxlist::bus {

/// Random content for each type. Half of the numbers are small ones that a service would believe,
/// the others random bits: NaN, infinity and the extremes come up.
class Filler {
 public:
  enum class Values {
    kAny,
    /// Only what every language writes as it read it: the plain NaN, and booleans of 0 and 1.
    kPortable,
  };

  explicit Filler(std::mt19937& random, Values values = Values::kAny)
      : random_(random), values_(values) {}

  void fill(std::int64_t& v) { v = static_cast<std::int64_t>(small() ? random_() % 4 : bits64()); }
  void fill(std::int32_t& v) { v = static_cast<std::int32_t>(small() ? random_() % 4 : random_()); }
  void fill(std::int8_t& v) { v = static_cast<std::int8_t>(random_()); }
  void fill(std::uint8_t& v) { v = static_cast<std::uint8_t>(random_()); }

  void fill(float& v) {
    v = small() ? static_cast<float>(random_() % 5) / 4.0F
                : std::bit_cast<float>(static_cast<std::uint32_t>(random_()));
    make_portable(v);
  }

  void fill(double& v) {
    v = small() ? static_cast<double>(random_() % 5) / 4.0 : std::bit_cast<double>(bits64());
    make_portable(v);
  }

  void fill(std::string& text) {
    text.resize(random_() % 12);
    for (char& c : text) c = static_cast<char>('!' + random_() % 90);
  }

  template <class T, std::size_t n>
  void fill(T (&values)[n]) {
    for (T& v : values) fill(v);
  }

  template <class T>
  void fill(std::vector<T>& values) {
    for (T& v : values) fill(v);
  }

  template <class T>
  void list(std::int32_t& count, std::vector<T>& values) {
    count = static_cast<std::int32_t>(random_() % 9);
    values.resize(static_cast<std::size_t>(count));
    fill(values);
  }

  void rows(std::size_t count, std::size_t columns, std::vector<std::vector<float>>& rows) {
    rows.assign(count, std::vector<float>(columns));
    fill(rows);
  }

  void fill(counter_t& m) { fill_all(m.name, m.count); }
  void fill(gauge_t& m) { fill_all(m.name, m.value); }
  void fill(moving_obstacle_t& m) { fill_all(m.position, m.velocity, m.radius_m); }
  void fill(pose_mode_t& m) { fill_all(m.pose, m.covariance, m.tilt, m.overlap, m.probability); }
  void fill(voxel_block_t& m) { fill_all(m.x, m.y, m.z, m.bits); }
  void fill(map_request_t& m) { fill_all(m.utime, m.want, m.first, m.map_id, m.version); }
  void fill(edited_box_t& m) { fill_all(m.id, m.kind, m.lowest, m.highest, m.moved); }
  void fill(map_edit_t& m) { fill_all(m.utime, m.map_id, m.action, m.id, m.lowest, m.highest); }
  void fill(map_edits_t& m) {
    fill_all(m.utime, m.map_id, m.answers, m.refusal, m.edits, m.moves);
    list(m.n_boxes, m.boxes);
  }
  void fill(rigid_transform_t& m) { fill_all(m.utime, m.trans, m.quat); }
  void fill(uncertain_pose_t& m) {
    fill_all(m.utime, m.map_id, m.map_version, m.cloud_utime, m.pose, m.covariance);
  }
  void fill(pose_hint_t& m) { fill_all(m.utime, m.map_id, m.pose, m.sigma_m, m.sigma_rad); }
  void fill(pose_t& m) { fill_all(m.utime, m.pos, m.vel, m.orientation, m.rotation_rate, m.accel); }

  void fill(health_t& m) {
    fill_all(m.utime, m.service, m.version, m.pid, m.state, m.message);
    list(m.n_counters, m.counters);
    list(m.n_gauges, m.gauges);
    fill_all(m.latency_p50_ms, m.latency_p99_ms, m.latency_max_ms);
  }

  void fill(localisation_t& m) {
    fill_all(m.utime, m.map_id, m.map_version, m.state, m.significance_log10, m.confidence);
    list(m.n_modes, m.modes);
    fill_all(m.certified, m.searched_whole_map, m.poses_examined, m.elapsed_us);
  }

  void fill(map_octree_t& m) {
    fill_all(m.utime, m.map_id, m.view_id, m.transform);
    list(m.num_bytes, m.data);
  }

  void fill(map_update_t& m) {
    fill_all(m.utime, m.map_id, m.answers, m.version, m.base_version, m.chunk, m.n_chunks,
             m.resolution_m, m.passed_resolution_m);
    list(m.n_blocks, m.blocks);
    list(m.n_passed_blocks, m.passed_blocks);
  }

  void fill(keyframe_t& m) {
    fill_all(m.utime, m.map_id, m.index, m.trans, m.quat);
    m.n_points = small_count();
    m.n_origins = small_count();
    rows(static_cast<std::size_t>(m.n_points), 3, m.points);
    rows(static_cast<std::size_t>(m.n_origins), 3, m.origins);
  }

  void fill(obstacles_t& m) {
    fill_all(m.utime, m.blind, m.min_height_m, m.max_height_m, m.rad0, m.radstep);
    list(m.n_bearings, m.ground_seen_to_m);
    rows(3, m.ground_seen_to_m.size(), m.nearest_m);
    list(m.n_moving, m.moving);
    list(m.n_cells, m.types);
    rows(static_cast<std::size_t>(m.n_cells), 2, m.cells);
  }

  void fill(pixel_map_t& m) {
    fill_all(m.utime, m.dimensions, m.xy0, m.xy1, m.mpp, m.compressed, m.data_type);
    list(m.datasize, m.mapData);
  }

  void fill(traversability_t& m) {
    fill_all(m.utime, m.map_id, m.version, m.profile, m.resolution_m, m.xy0, m.dimensions,
             m.compressed);
    list(m.datasize, m.cells);
  }

  void fill(mirror_state_t& m) {
    fill_all(m.utime, m.state, m.angle_known, m.reason, m.angle_rad, m.rate_radps,
             m.half_revolutions, m.residual_rad, m.step_rad);
    if (values_ == Values::kPortable) m.angle_known &= 1;
  }

  void fill(planar_lidar_t& m) {
    fill_all(m.utime, m.rad0, m.radstep);
    list(m.nranges, m.ranges);
    list(m.nintensities, m.intensities);
  }

  void fill(pointcloud_t& m) {
    fill_all(m.utime, m.seq, m.frame_id);
    m.n_points = small_count();
    rows(static_cast<std::size_t>(m.n_points), 3, m.points);
    list(m.n_channels, m.channel_names);
    rows(static_cast<std::size_t>(m.n_channels), static_cast<std::size_t>(m.n_points), m.channels);
  }

 private:
  template <class... T>
  void fill_all(T&... values) {
    (fill(values), ...);
  }

  template <class T>
  void make_portable(T& v) const {
    if (values_ == Values::kPortable && std::isnan(v)) v = std::numeric_limits<T>::quiet_NaN();
  }

  bool small() { return random_() % 2 == 0; }
  std::int32_t small_count() { return static_cast<std::int32_t>(random_() % 9); }
  std::uint64_t bits64() { return std::uint64_t{random_()} << 32 | random_(); }

  std::mt19937& random_;
  Values values_;
};

}  // namespace voxlist::bus
