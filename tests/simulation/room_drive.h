#pragma once

#include <cstdint>
#include <functional>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/simulation/world/world.h"

namespace voxlist::simulation {

/// A robot on a simulated floor of a seed: it drives from room to room, a scan each half metre, by
/// a laser of 48 rings that sees 12 m far; or covered, then each scan is of its lid.
class RoomDrive {
 public:
  /// Is given each scan, in base, and where it was taken.
  using Take = std::function<void(const Cloud&, const Pose2&)>;

  RoomDrive(int seed, Take take);

  std::size_t rooms() const { return world_.building().rooms.size(); }
  Pose2 middle_of(std::size_t room) const;

  /// The robot is put into a room.
  void stand_in(std::size_t room) { at_ = middle_of(room); }

  /// Out by one room's door and in by the other's, up to the inside of that.
  void drive(std::size_t from, std::size_t to, bool covered);

  /// From where it is through the middle of a room, and about in it.
  void look_round(std::size_t room);

 private:
  void drive_to(const Pose2& to, bool covered);
  Cloud scan(bool covered);

  const World world_;
  const Take take_;
  const std::uint64_t seed_;
  std::uint64_t scans_ = 0;
  Pose2 at_;
};

}  // namespace voxlist::simulation
