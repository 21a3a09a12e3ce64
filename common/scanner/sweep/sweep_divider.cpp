#include "voxlist/scanner/sweep/sweep_divider.h"

#include <cmath>

#include "voxlist/geometry/angle.h"

namespace voxlist::scanner {

SweepDivider::Place SweepDivider::next(double phi_rad, double rate_radps) {
  const std::int64_t forward = rate_radps < 0.0 ? -1 : 1;
  std::int64_t here = sweep_at(phi_rad);
  // A mirror that turns in steps may not quite have reached what was expected of it: its line is
  // the first of the new sweep all the same, and no step back into an old one.
  if (closed_ && here == *closed_) here += forward;
  if (open_ && here == *open_ - forward) here = *open_;

  Place place{};
  place.starts_sweep = open_ != here;
  place.ends_sweep = (sweep_at(phi_rad + rate_radps * line_period_s_) - here) * forward > 0;
  place.sweep_lines = kTurn_rad / (std::abs(rate_radps) * line_period_s_);
  open_.reset();
  closed_.reset();
  (place.ends_sweep ? closed_ : open_) = here;
  return place;
}

void SweepDivider::forget() {
  open_.reset();
  closed_.reset();
}

std::int64_t SweepDivider::sweep_at(double phi_rad) const {
  return std::llround(std::floor((phi_rad - boundary_rad_) / kTurn_rad));
}

}  // namespace voxlist::scanner
