#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "voxlist/bus/counters.h"
#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/bus/wire.h"
#include "voxlist/foreign/foxglove/audience.h"
#include "voxlist/foreign/foxglove/map_points.h"
#include "voxlist/foreign/foxglove/retelling.h"
#include "voxlist/foreign/foxglove/space_points.h"

namespace voxlist::foreign {

struct ConverterConfig {
  /// Largest edge of the voxels that the map is told in (m), unless its own are larger.
  double map_detail_m = 0.1;
  /// When map and path are told again.
  RetellingConfig retelling;
};

/// What the bus says, as Foxglove's messages (README.md has the topics). What makes no sense is
/// counted and left out.
class Converter {
 public:
  /// The audience must outlive it.
  Converter(Audience& audience, const ConverterConfig& config);

  /// A message as it came on a channel, without prefix: any bytes, of any channel.
  void take(const std::string& channel, bus::Bytes bytes);

  // The same, decoded.
  void take(const std::string& channel, const pointcloud_t& message);
  void take(const std::string& channel, const pose_t& message);
  void take(const std::string& channel, const rigid_transform_t& message);
  void take(const std::string& channel, const localisation_t& message);
  void take(const std::string& channel, const obstacles_t& message);
  void take(const std::string& channel, const pixel_map_t& message);
  void take(const std::string& channel, const traversability_t& message);
  void take(const std::string& channel, const planar_lidar_t& message);
  void take(const std::string& channel, const health_t& message);
  void take(const std::string& channel, const keyframe_t& message);

  /// Changes of the map, and of free space, from whoever put them together. MAP_UPDATE and
  /// FREE_SPACE themselves are put together here.
  void take(const std::string& channel, const map_update_t& message);
  void take(const bus::MapChange& change);
  void take_space(const bus::MapChange& change);

  /// Whether anybody looks at free space, which is told by take_space().
  bool wants_space();

  /// Tells map, path and free space where they are due: they may have changed while nobody wanted
  /// them.
  void tick(std::int64_t utime_us);

  /// Tells them once more, if anything of them is new. For the end.
  void tell_rest();

  /// Messages that were left out, by channel and reason.
  const bus::Counters& faults() const { return faults_; }

 private:
  // What a service said last.
  struct Said {
    std::int64_t utime_us = 0;
    std::int32_t state = -1;
    std::string sentence;
  };

  template <class M>
  void decode(const std::string& channel, bus::Bytes bytes);
  void tell(const Topic& topic, std::int64_t utime_us, std::optional<std::string> message,
            const std::string& channel);
  void follow(std::int64_t utime_us, const Pose3& T_map_base);
  void tell_map(std::int64_t now_us);
  void tell_path(std::int64_t utime_us);
  void tell_space(std::int64_t now_us);

  Audience& audience_;
  bus::MapAssembler assembler_, space_assembler_;
  MapPoints map_;
  SpacePoints space_;
  Retelling map_retelling_, path_retelling_, space_retelling_;
  Packed path_;
  std::optional<Eigen::Vector3d> path_end_;
  std::int64_t path_utime_us_ = 0;
  std::int32_t state_ = -1;
  std::map<std::string, Said> said_;
  bus::Counters faults_;
};

}  // namespace voxlist::foreign
