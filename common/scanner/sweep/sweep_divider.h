#pragma once

#include <cstdint>
#include <optional>

namespace voxlist::scanner {

/// Divides the laser's lines into sweeps of 360 deg of phi. A sweep is whole lines, and its last
/// line is known when it comes, by where the next one will begin.
class SweepDivider {
 public:
  /// `boundary_rad`: the phi where sweeps begin. `line_period_s`: from line to line.
  SweepDivider(double boundary_rad, double line_period_s)
      : boundary_rad_(boundary_rad), line_period_s_(line_period_s) {}

  /// Where a line is.
  struct Place {
    bool starts_sweep;   ///< the sweep before it, if one is open, has ended
    bool ends_sweep;     ///< it is its sweep's last
    double sweep_lines;  ///< that a whole sweep has at this speed; infinity when the mirror stands
  };

  /// Takes the next line's continuous phi and its rate, with sign, both when its first beam left.
  Place next(double phi_rad, double rate_radps);

  /// The next line starts a sweep, wherever it is.
  void forget();

 private:
  std::int64_t sweep_at(double phi_rad) const;

  double boundary_rad_, line_period_s_;
  std::optional<std::int64_t> open_, closed_;  // numbers of the sweep that is open, or was last
};

}  // namespace voxlist::scanner
