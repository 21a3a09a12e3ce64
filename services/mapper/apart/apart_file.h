#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"

namespace voxlist::bus {
class EventLogWriter;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// Name of the recording, in a map's folder, of clouds that have no place in the map yet. Older
/// ones that never got any have a number behind it.
inline constexpr const char* kApartFile = "apart.lcm";

/// A cloud that is kept apart, where it is in its piece or in the map, and odometry's pose then.
struct ApartCloud {
  Cloud cloud;
  Pose3 pose = Pose3::Identity();
  std::optional<Pose2> T_odom_base;
};

/// The recordings of clouds that are kept apart, beside a map: `voxlist extend` reads them.
class ApartFile {
 public:
  /// Keeps the file in this folder, or nowhere (empty).
  ApartFile(bus::Health& health, const std::filesystem::path& folder);
  ~ApartFile();

  bool is_possible() const { return !folder_.empty(); }
  std::filesystem::path path() const { return folder_ / kApartFile; }

  /// Appends a cloud: kill -9 does not lose it. What the disk does not take is counted in HEALTH.
  void write(const ApartCloud& kept);

  /// All of it has its place.
  void remove();

  /// Gives it a number: it has no place.
  void leave();

  /// What an earlier process was writing when it ended, which has a number now; remove_left() it
  /// once it is read.
  std::optional<std::filesystem::path> left_by_another();
  void remove_left(const std::filesystem::path& file);

 private:
  void tell() const;

  bus::Health& health_;
  const std::filesystem::path folder_;
  std::unique_ptr<bus::EventLogWriter> log_;
  std::vector<std::string> left_;  // names of those that have a number
};

/// Reads such a recording. What is damaged is left out.
std::vector<ApartCloud> read_apart_file(const std::filesystem::path& file);

}  // namespace voxlist::services
