#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/geometry/laser_line.h"

namespace voxlist::scanner {

/// One blocking arm: a rod that turns with the mirror and once a revolution stands between the
/// laser and the mirror.
struct BlockingArm {
  double angle_rad = 0.0;       ///< mirror angle at the middle of its passage
  double first_beam_rad = 0.0;  ///< the beams that it blocks; its ends may be a beam off
  double last_beam_rad = 0.0;
};

/// Something happened after one beam left and before another did, microseconds.
struct TimeSpan {
  std::int64_t after_us = 0;
  std::int64_t before_us = 0;
};

/// One passage of an arm: between a free beam and a blocked one it came, and between a blocked
/// one and a free one it left. Lines are 13 ms apart, so that is as much as the beams tell.
struct ArmPassage {
  std::size_t arm = 0;
  TimeSpan enter, leave;

  std::int64_t middle_us() const {
    return enter.after_us +
           ((enter.before_us - enter.after_us) + (leave.after_us - enter.after_us) +
            (leave.before_us - enter.after_us)) /
               4;
  }
};

/// Finds the passages of the blocking arms in the laser's lines. What an arm's beams meet lower
/// than the mirror is the arm, unless the beams between and beside the arms meet something there
/// too: then it is the edge of the mirror's plate. Beams without a measurement say nothing; lost
/// lines widen the spans.
class ArmDetector {
 public:
  /// `height_max_m`: above the laser's optical centre, higher than the arms in front of it and
  /// lower than the mirror's axis.
  ArmDetector(std::vector<BlockingArm> arms, double height_max_m);

  /// Takes the next line; lines come in the order of time. Returns the passages that it ends.
  std::vector<ArmPassage> add(const LaserLine& line);

  /// Forgets passages under way.
  void reset();

 private:
  // What a line says of one arm: its first beams and its last ones, and where that changes.
  struct Sight {
    bool first_blocked, last_blocked;
    std::int64_t first_us, last_us;
    TimeSpan change;  // where first_blocked != last_blocked
  };
  struct Watch {
    std::optional<std::int64_t> free_us, blocked_us;  // last beam seen so; of these the newer
    std::optional<TimeSpan> enter;
  };

  bool is_near(const LaserLine& line, std::size_t beam) const;
  bool shows_edge(const LaserLine& line, const BlockingArm& arm) const;
  std::optional<Sight> look(const LaserLine& line, const BlockingArm& arm) const;
  static std::optional<ArmPassage> follow(Watch& watch, const Sight& sight);

  std::vector<BlockingArm> arms_;
  double height_max_m_;
  double fan_begin_rad_ = 1.5;  // beams from here to pi minus this meet the mirror
  std::vector<Watch> watches_;
  std::optional<std::int64_t> last_line_us_;
};

}  // namespace voxlist::scanner
