#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/laser_line.h"
#include "voxlist/geometry/mirror_state.h"
#include "voxlist/geometry/odometry_buffer.h"
#include "voxlist/scanner/sweep/assembly_counts.h"
#include "voxlist/scanner/sweep/beam_geometry.h"
#include "voxlist/scanner/sweep/cloud_assembler_config.h"
#include "voxlist/scanner/sweep/mirror_motion.h"
#include "voxlist/scanner/sweep/moving_points.h"
#include "voxlist/scanner/sweep/sweep_divider.h"

namespace voxlist::scanner {

/// What became complete, oldest first, and what happened on the way.
struct Assembly {
  /// One for each sweep, in base at the time when its last line's last beam left: its utime.
  std::vector<Cloud> clouds;

  /// Parts of sweeps, each in base at the time of its own last beam. Together they have the sweep's
  /// points.
  std::vector<Cloud> slices;

  /// The share of its lines (0..1) that the sweep had which ended last, handed out or not.
  std::optional<double> line_share;

  /// What was used and what was not, by reason.
  AssemblyCounts counts;
};

/// Lines of the laser, the mirror's states and odometry in, clouds out. Every beam is reflected at
/// its own mirror angle and seen from where the robot was at its own time.
///
/// A line whose mirror angle or odometry is not known yet waits, and all later ones behind it, up
/// to max_wait_ms of LASER's time; then it is dropped. So without odometry (and with use_odometry)
/// there are no clouds: a planner stops for old ones, but cannot see that one is smeared. When the
/// mirror's angle gets lost, the sweep that is open is thrown away: nobody knows since when it is
/// wrong. Time is the messages' own.
class CloudAssembler {
 public:
  /// Throws std::invalid_argument that says which settings do not fit together.
  explicit CloudAssembler(const CloudAssemblerConfig& config);
  CloudAssembler(const CloudAssembler&) = delete;
  CloudAssembler& operator=(const CloudAssembler&) = delete;

  /// Takes the next line.
  Assembly add_line(LaserLine line);

  Assembly add_mirror(const MirrorState& state);

  /// Takes T_odom_base.
  Assembly add_odometry(const StampedPose2& T_odom_base);

 private:
  // Points on their way out: of a sweep, or of a slice.
  struct Part {
    MovingPoints points;
    int lines = 0;
    std::int64_t end_us = 0;
    double whole_lines = 0.0;

    void clear();
  };

  void note_time(const LaserLine& line, Assembly& out);
  void advance(Assembly& out);
  // What the line lacks of mirror and odometry; nothing when it can be assembled.
  std::optional<LineFate> look_up(const LaserLine& line);
  bool is_overdue(const LaserLine& line) const;
  void drop(LineFate why, Assembly& out);
  void assemble(const LaserLine& line, Assembly& out);
  void place_beams(const LaserLine& line, Assembly& out);
  void end_slice(Assembly& out);
  void end_sweep(Assembly& out);
  void abandon_sweep(SweepLoss why, Assembly& out);

  const CloudAssemblerConfig config_;
  const std::int64_t odometry_reach_us_;
  const BeamGeometry beams_;
  MirrorMotion motion_;
  OdometryBuffer odometry_;
  SweepDivider divider_;
  Part sweep_, slice_;
  std::deque<LaserLine> waiting_;  // oldest first
  std::optional<std::int64_t> newest_us_;
  std::vector<MirrorAt> mirror_;  // for each beam of the line that was looked up last
};

}  // namespace voxlist::scanner
