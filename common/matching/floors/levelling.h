#pragma once

#include <optional>
#include <vector>

#include "voxlist/geometry/tilt.h"
#include "voxlist/matching/scan/floor.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::matching {

/// What is known of a cloud's tilt by itself.
struct KnownTilt {
  /// The floor that it shows.
  std::optional<Floor> floor;
  /// Odometry's roll and pitch at its time.
  std::optional<Tilt> odometry;
};

/// How a cloud is tilted against the map, before the map's surfaces are asked.
class Levelling {
 public:
  /// What the tilt of a robot may be that is expected at a place; at least one. Odometry's comes
  /// before all others.
  std::vector<Tilt> guesses(const KnownTilt& known, const Pose2& place) const;

  /// Whether a robot may be tilted like this at a place, by the way from the last cloud: it climbs
  /// as its wheels lean, and does not jump.
  bool reaches(const Pose2& place, const Tilt& tilt) const;

  /// The same of a robot that may be anywhere: on each floor of the map that was looked at, or at
  /// its origin's height.
  std::vector<Tilt> guesses_anywhere(const KnownTilt& known) const;

  /// The tilt of the last cloud, as far as one is known.
  Tilt last() const { return last_ ? last_->tilt : Tilt{}; }

  /// The cloud that begins a map is made level; its base is at height 0.
  static Tilt of_origin(const KnownTilt& known);

  /// A cloud with that floor was surely taken at this place, and tilted like this.
  void learn(const Pose2& place, const Tilt& tilt, const std::optional<Floor>& floor);

  /// Goes on in another map. `T_new_old`: from the map so far to that one.
  void change_map(const Pose2& T_new_old);

  /// The robot may have been carried: what is known of the last cloud says nothing of the next.
  void forget() { last_.reset(); }

  /// The map's floors, and the one on which its origin stands as far as nothing else is known of
  /// it.
  void look_at(const OccupancyMap& map);

 private:
  struct Last {
    Pose2 place;
    Tilt tilt;
  };
  double height_m(const Pose2& place, const Tilt& tilt) const;

  std::optional<Last> last_;
  // Height of the floor (m) on which the robot was last, or the map's origin stands.
  std::optional<double> floor_m_;
  // Heights (m) of all the map's floors, and the map's revision when they were found.
  std::vector<double> floors_m_;
  std::optional<MapRevision> looked_at_;
};

/// The tilt that lays a cloud's floor onto the map's about a place and a height (m) there; nothing
/// where the map shows no floor there. About 5 ms.
std::optional<Tilt> floor_on_floor(const OccupancyMap& map, const Pose2& place, double height_m,
                                   const Floor& floor);

}  // namespace voxlist::matching
