#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace voxlist::scanner {

/// What a packet is.
enum class VelodyneKind {
  kData,
  kNoData,        ///< of another length: its position packets, or somebody else's
  kBroken,        ///< of the right length, but its blocks do not begin as they must
  kUnknownModel,  ///< of a laser that is neither VLP-16 nor HDL-32E
};

/// One return.
struct VelodyneReturn {
  Eigen::Vector3f point;       ///< m; x ahead at azimuth 0, y left, z up
  double after_us = 0.0;       ///< when it was measured, after the packet's time
  std::uint8_t ring = 0;       ///< from 0, the lowest first
  std::uint8_t intensity = 0;  ///< reflectivity: above 100 is a retro-reflector
};

/// The returns of one block: of an azimuth, in the order of time.
struct VelodyneBlock {
  int azimuth_cdeg = 0;  ///< clockwise, 0 to 35,999
  std::vector<VelodyneReturn> returns;
};

struct VelodynePacket {
  VelodyneKind kind = VelodyneKind::kNoData;
  std::uint8_t model = 0;  ///< as the packet says
  /// The laser's clock at the packet's first firing: microseconds since its hour began.
  std::uint32_t stamp_us = 0;
  double length_us = 0.0;  ///< to the next packet's first firing
  std::vector<VelodyneBlock> blocks;
};

/// The bytes of a data packet.
inline constexpr std::size_t kVelodyneBytes = 1206;

/// What the laser's clock counts up to (us).
inline constexpr std::int64_t kVelodyneHour_us = 3'600'000'000;

/// Reads a UDP packet's payload. Rays that did not come back are left out. With two returns a ray
/// both are there, once where they are the same.
VelodynePacket read_velodyne(std::span<const std::uint8_t> payload);

}  // namespace voxlist::scanner
