#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "voxlist/scanner/sweep/beam_geometry.h"

namespace voxlist::scanner {

/// What became of a line of LASER, or what its time said.
enum class LineFate {
  kAssembled,
  kDeadSide,         ///< seen by the side of the mirror that does not reflect
  kMirrorLost,       ///< MIRROR said that its angle is not known
  kMirrorUnknown,    ///< MIRROR began too late, or has a hole
  kMissing,          ///< did not come: a hole in LASER's times
  kNoMirrorYet,      ///< waited too long for MIRROR
  kNoOdometry,       ///< waited too long for ODOMETRY
  kOutOfOrder,       ///< older than a line before it
  kTimeStartedAnew,  ///< so much older that all was forgotten
  kTooManyWaiting,   ///< pushed out by newer lines
};
inline constexpr std::size_t kLineFates = 10;

/// Why a sweep was not handed out.
enum class SweepLoss {
  kTooFewLines,
  kMirrorLost,
  kOdometryLost,
  kTooLong,  ///< more points than any sweep has: its mirror hardly turns
};
inline constexpr std::size_t kSweepLosses = 4;

/// How often each thing happened on the way from lines to clouds.
struct AssemblyCounts {
  std::array<std::int64_t, kLineFates> lines{};
  std::array<std::int64_t, kBeamFates> beams{};  ///< of assembled lines
  std::array<std::int64_t, kSweepLosses> sweeps{};

  std::int64_t& operator[](LineFate fate) { return lines[static_cast<std::size_t>(fate)]; }
  std::int64_t operator[](LineFate fate) const { return lines[static_cast<std::size_t>(fate)]; }
  std::int64_t& operator[](BeamFate fate) { return beams[static_cast<std::size_t>(fate)]; }
  std::int64_t& operator[](SweepLoss loss) { return sweeps[static_cast<std::size_t>(loss)]; }
};

/// Whether a line was used: it got as far as a cloud, or needs not to.
bool has_used_line(const AssemblyCounts& counts);

/// What happened to a line that was not used; the last in the fates' order when there are several.
std::optional<LineFate> unused_line(const AssemblyCounts& counts);

/// The fate as HEALTH counts it, "LASER/no_odometry".
std::string counter_name(LineFate fate);

/// All that happened, as HEALTH counts it: LASER/..., beams/..., CLOUD/....
std::map<std::string, std::int64_t> by_counter_name(const AssemblyCounts& counts);

}  // namespace voxlist::scanner
