#include "services/localiser/findings_in_health.h"

#include <fmt/core.h>

#include <cmath>
#include <string>

#include "voxlist/bus/health.h"
#include "voxlist/geometry/angle.h"

namespace voxlist::services {

FindingsInHealth::FindingsInHealth(bus::Health& health, service::ChannelCheck& odometry,
                                   TiltUse tilt)
    : health_(health), odometry_(odometry), tilt_(tilt) {}

void FindingsInHealth::tell(const matching::Localisation& found, bool has_map) {
  if (found.odometry_error) tell(*found.odometry_error);
  if (found.odometry_bias) tell(*found.odometry_bias);
  if (found.floor) tell(*found.floor);
  health_.count(std::string("state/") + name(found.state));
  tell(found.state, has_map);
}

void FindingsInHealth::tell_missing_odometry(std::int64_t cloud_utime_us,
                                             std::optional<std::int64_t> newest_us) {
  if (!newest_us) return;
  const double older_s = static_cast<double>(cloud_utime_us - *newest_us) * 1e-6;
  health_.count("ODOMETRY/not_of_this_time");
  odometry_.note("not_of_this_time", bus::Health::State::kWarning,
                 fmt::format("ODOMETRY is {:.1f} s {} than CLOUD and is not used: do their "
                             "clocks agree?",
                             std::abs(older_s), older_s > 0.0 ? "older" : "newer"));
}

void FindingsInHealth::tell(const matching::OdometryError& error) {
  if (!error.disagrees()) return;
  health_.count("ODOMETRY/disagrees");
  odometry_.note(
      "disagrees", bus::Health::State::kWarning,
      fmt::format(
          "ODOMETRY disagrees with the scans, which are believed: over {:.2f} m in {:.1f} s "
          "it is off by {:.2f} m and {:.1f} deg. Do wheels slip?",
          error.way_m, error.seconds, error.distance_m, error.turn_rad / kRadPerDeg));
}

void FindingsInHealth::tell(const matching::OdometryBias& bias) {
  constexpr double kPercent = 100.0;
  health_.gauge("odometry_scale_percent", bias.scale * kPercent);
  health_.gauge("odometry_scale_sigma_percent", bias.scale_sigma * kPercent);
  health_.gauge("odometry_heading_deg", bias.heading_rad / kRadPerDeg);
  health_.gauge("odometry_heading_sigma_deg", bias.heading_sigma_rad / kRadPerDeg);
}

// A sentence that changes with every cloud could not be read.
void FindingsInHealth::tell(const matching::Floor& floor) {
  constexpr double kNews_rad = 1.0 * kRadPerDeg, kNews_m = 0.1;
  health_.gauge("floor_tilt_deg", floor.lean_rad() / kRadPerDeg);
  health_.gauge("floor_height_m", floor.height_m());
  const bool is_news = !told_floor_ ||
                       std::abs(floor.lean_rad() - told_floor_->lean_rad()) > kNews_rad ||
                       std::abs(floor.height_m() - told_floor_->height_m()) > kNews_m;
  if (!is_news) return;
  told_floor_ = floor;
  const bool must_be_level = tilt_ == TiltUse::kPlanar;
  health_.raise("floor", bus::Health::State::kWarning, must_be_level ? what_is_off(floor) : "");
}

void FindingsInHealth::tell(matching::LocalisationState state, bool has_map) {
  using State = bus::Health::State;
  const bool is_sure = state == matching::LocalisationState::kTracking;
  health_.raise("map", State::kWarning, has_map ? "" : "waits for a map: is the mapper running?");
  health_.raise("pose", State::kWarning, is_sure || !has_map ? "" : name(state));
}

}  // namespace voxlist::services
