#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/scanner/velodyne/velodyne_packet.h"

namespace voxlist::scanner {

/// One turn of the laser, from behind the x axis round to it (azimuth 180 to 180 deg).
struct VelodyneSweep {
  std::int64_t utime_us = 0;  ///< of its first block
  std::vector<Eigen::Vector3f> points;
  std::vector<float> after_s;  ///< when each was measured, after utime
  std::vector<float> rings;
  std::vector<float> intensities;
};

/// Puts packets together to sweeps, in the order in which they came. The laser's clock tells the
/// time, which is set by the first packet's arrival: on its network it comes within a millisecond.
class VelodyneSweeps {
 public:
  /// Adds a data packet that arrived at this time. The sweep that it ends, if it does.
  std::optional<VelodyneSweep> add(const VelodynePacket& packet, std::int64_t arrival_us);

  /// What is there of the last sweep, at the end.
  std::optional<VelodyneSweep> finish();

  /// Packets that are missing between those that came, by the laser's clock.
  std::int64_t missing_packets() const { return missing_; }

  /// Packets that came after a later one: they are left out.
  std::int64_t late_packets() const { return late_; }

  /// By how much the laser's clock has gone ahead of the arrivals' since the first packet.
  std::int64_t drift_us() const { return drift_us_; }

 private:
  bool ends_before(const VelodyneBlock& block) const;
  void take(const VelodyneBlock& block, std::int64_t packet_us);

  VelodyneSweep sweep_;
  std::optional<std::uint32_t> stamp_us_;  // of the last packet
  std::optional<int> azimuth_cdeg_;        // of the last block, counted from behind
  std::int64_t utime_us_ = 0;              // of the last packet
  std::int64_t drift_us_ = 0;
  double length_us_ = 0.0;
  std::int64_t missing_ = 0, late_ = 0;
};

}  // namespace voxlist::scanner
