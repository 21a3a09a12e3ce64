#pragma once

#include <cstdint>
#include <optional>

#include "voxlist/geometry/cloud.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::services {

/// Whether the only cloud of a map was a bad one, such as of a lid before the scanner: then two
/// later clouds fit each other, and neither fits it. Two, so that one bad cloud does not cost a
/// good map.
class OriginDoubt {
 public:
  explicit OriginDoubt(const matching::LocaliserConfig& config) : localiser_(other_, config) {}

  /// A map of one cloud, or of none. `is_own`: that cloud was seen from where the robot is now.
  /// Else the map is older, and the robot may be somewhere else in it: it is doubted after ten
  /// clouds in a row that are LOST.
  void begin(std::int64_t map_id, bool is_own);

  /// A cloud fits, or the map is more than one cloud: no doubt any more.
  void end();

  /// Nothing came of the doubt: the next one takes ten clouds.
  void postpone();

  /// Whether this map is known here.
  bool knows(std::int64_t map_id) const { return map_id_ == map_id; }

  /// A cloud does not fit. Whether the map is to be doubted.
  bool add(matching::LocalisationState state);

  /// Whether a map could begin with that cloud instead; the next ones are compared with it.
  bool try_origin(const Cloud& cloud, const std::optional<Pose2>& T_odom_base);

  /// Whether the cloud fits that one.
  bool fits_it(const Cloud& cloud, const std::optional<Pose2>& T_odom_base);

 private:
  void end_trial();

  std::optional<std::int64_t> map_id_;
  bool is_open_ = false;
  int patience_ = 0;    // clouds until it is doubted
  OccupancyMap other_;  // of the cloud that another map could begin with
  matching::Localiser localiser_;
};

}  // namespace voxlist::services
