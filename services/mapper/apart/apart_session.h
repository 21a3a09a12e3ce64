#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "voxlist/geometry/cloud.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::bus {
class EventLogWriter;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// Name of the recording, in a map's folder, of clouds that have no place in the map yet.
inline constexpr const char* kApartFile = "apart.lcm";

/// The clouds of a session that began on a saved map, kept apart until the robot is found there:
/// in memory, and in a recording that `voxlist map --into` reads. Then they are tracked from the
/// found one backwards, and those that surely fit get their place in the map, as it grows.
class ApartSession {
 public:
  /// A session on the saved map of this folder; nothing is kept without one (empty). A recording of
  /// before is kept under a name of its own.
  ApartSession(bus::Health& health, const std::filesystem::path& folder, TiltUse tilt);
  ~ApartSession();

  /// Whether clouds without a place are to be kept.
  bool is_waiting() const { return state_ == State::kWaiting; }

  /// A cloud has no place. Where odometry says that the robot has hardly moved, it is not kept.
  void add(Cloud cloud, const std::optional<Pose2>& T_odom_base);

  /// The robot is found: where it was at a time.
  void found(std::int64_t utime_us, const std::optional<Pose2>& T_odom_base,
             const UncertainPose& pose, const OccupancyMap& map);

  /// A cloud that has its place now.
  struct Placed {
    Cloud cloud;
    Pose2 T_map_base;
    Tilt tilt;
    std::optional<Pose2> T_odom_base;
  };

  /// Looks at the newest cloud that is left, if any; what surely fits is returned, and to be added
  /// to the map before the next. It takes as long as localising a cloud does.
  std::optional<Placed> place_next();

  /// The map of found() has gained or lost something.
  void map_changed(const ChangedBlocks& changed);

  /// The map of found() goes: what has no place keeps none.
  void end();

 private:
  enum class State { kWaiting, kJoining, kDone };

  struct Kept {
    Cloud cloud;
    std::optional<Pose2> T_odom_base;
  };

  bool keep_recording_of_before() const;
  bool has_moved(const std::optional<Pose2>& T_odom_base) const;
  void record(const Kept& kept);
  void tell() const;

  bus::Health& health_;
  const std::filesystem::path folder_;
  const TiltUse tilt_;
  State state_ = State::kDone;
  std::deque<Kept> kept_;  // oldest first
  std::size_t bytes_ = 0;
  std::unique_ptr<bus::EventLogWriter> recording_;
  // Goes backwards in time from when the robot was found.
  std::unique_ptr<matching::Localiser> localiser_;
  std::int64_t found_us_ = 0;
  int misses_ = 0;
  std::int64_t without_place_ = 0;
};

}  // namespace voxlist::services
