#pragma once

#include <cstdint>
#include <deque>

#include "voxlist/geometry/mirror_state.h"

namespace voxlist::scanner {

/// A line or a state that is older than the one before by more than this (us) is not late: time
/// started anew, as when a log is played again. Messages that overtake each other on the bus are
/// milliseconds apart.
inline constexpr std::int64_t kTimeStartsAnew_us = 1'000'000;

/// What is known of the mirror at a time.
struct MirrorAt {
  enum class Known {
    kYes,
    kNotYet,  ///< later than the newest state reaches: wait for the next
    kLost,    ///< the state of that time says that the angle is not known
    kNever,   ///< before all states, or in a hole between them
  };
  Known known = Known::kNotYet;

  /// Continuous, not wrapped: the mirror's turns are counted from some whole one.
  double psi_rad = 0.0;
  double rate_radps = 0.0;
};

/// The mirror's angle over time, from the states that arrived so far.
class MirrorMotion {
 public:
  /// A mirror that is turned by a crystal's clock moves on for a while as its last state says: for
  /// at most `max_extrapolation_us` after it (or, where there is no earlier one, before it).
  /// `staircase`: it stands still between the motor's steps; else it turns evenly.
  MirrorMotion(bool staircase, std::int64_t max_extrapolation_us)
      : staircase_(staircase), max_extrapolation_us_(max_extrapolation_us) {}

  /// Takes the next state. One of the same time replaces the older; one that is more than a second
  /// older than the newest means that time started anew, and all before it is forgotten.
  void add(const MirrorState& state);

  MirrorAt at(std::int64_t utime_us) const;

 private:
  MirrorAt moved(const MirrorState& state, std::int64_t utime_us) const;

  bool staircase_;
  std::int64_t max_extrapolation_us_;
  std::deque<MirrorState> states_;  // by time, angles continuous
};

}  // namespace voxlist::scanner
