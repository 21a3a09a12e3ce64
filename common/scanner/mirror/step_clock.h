#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/scanner/mirror/edge_pace.h"

namespace voxlist::scanner {

/// Counts the steps of the motor's crystal clock from the times of its edges, as they came through
/// a stream that jitters, loses edges and doubles them. The period is measured. Missing edges are
/// counted by the time that has passed: an edge that a stream lost is a step that the motor made.
///
/// A stream that loses more than about 40 % of its edges is taken for a slower clock.
class StepClock {
 public:
  struct Counts {
    std::int64_t edges = 0;    ///< that came
    std::int64_t lost = 0;     ///< put in
    std::int64_t doubled = 0;  ///< at a time that had its edge already; left out
    std::int64_t strange = 0;  ///< between two edges; left out
    std::int64_t restarts = 0;
    std::int64_t rate_changes = 0;  ///< restarts because edges no longer fitted the period
  };

  /// Takes the next edge. The count starts anew after a gap of over 2 s, a step back in time, or
  /// when the edges no longer fit the period: see EdgePace.
  void add_edge(std::int64_t utime_us);

  /// Forgets everything but the counts.
  void reset();

  /// Whether the period is known. Only then may what follows be asked for.
  bool ready() const { return period_us_ > 0.0; }

  /// Ready, and an edge came lately.
  bool running(std::int64_t utime_us) const;

  double period_us() const { return period_us_; }

  /// Steps since the count's start, with the part of the step under way: smooth, also between and
  /// after edges.
  double steps_at(std::int64_t utime_us) const;

  /// The fitted time of an edge by its count, microseconds.
  std::int64_t edge_us(std::int64_t step) const;

  /// Grows when the count started anew: counts of two generations cannot be compared.
  std::int64_t generation() const { return counts_.restarts; }

  const Counts& counts() const { return counts_; }

 private:
  void learn();
  bool fits_no_longer(double since_us);
  void follow(double since_us);

  std::optional<std::int64_t> origin_us_;  // times below are since it
  double last_raw_us_ = 0.0;
  std::vector<double> first_us_;  // until the period is known
  double period_us_ = 0.0;
  double fitted_us_ = 0.0;  // of the last counted edge
  std::int64_t step_ = 0;   // its count
  double fitted_edges_ = 0.0;
  double badness_ = 0.0;
  EdgePace pace_;
  Counts counts_;
};

}  // namespace voxlist::scanner
