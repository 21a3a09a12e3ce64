#pragma once

#include <cstdint>
#include <optional>

#include "voxlist/geometry/tilt.h"
#include "voxlist/matching/localisation/localiser.h"
#include "voxlist/service/inputs/channel_check.h"

namespace voxlist::bus {
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// What localisations tell of the odometry, the floor and the pose, as counters, gauges and
/// sentences in HEALTH.
class FindingsInHealth {
 public:
  /// `odometry`: what the sentences about ODOMETRY are noted with. `tilt`: a floor that is not
  /// level is worth a sentence under TiltUse::kPlanar alone.
  FindingsInHealth(bus::Health& health, service::ChannelCheck& odometry, TiltUse tilt);

  void tell(const matching::Localisation& found, bool has_map);

  /// A cloud without odometry of its time; `newest_us`: the time of the newest odometry, if any.
  void tell_missing_odometry(std::int64_t cloud_utime_us, std::optional<std::int64_t> newest_us);

 private:
  void tell(matching::LocalisationState state, bool has_map);
  void tell(const matching::OdometryError& error);
  void tell(const matching::OdometryBias& bias);
  void tell(const matching::Floor& floor);

  bus::Health& health_;
  service::ChannelCheck& odometry_;
  const TiltUse tilt_;
  std::optional<matching::Floor> told_floor_;
};

}  // namespace voxlist::services
