#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/io/scans/folder_events.h"
#include "voxlist/io/scans/scan_folder.h"

namespace voxlist::bus {
class Bus;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// Settings of the scan source.
struct ScanSourceConfig {
  std::string folder;
  double speed = 1.0;
  bool loop = false;

  template <class Visitor>
  void visit(Visitor& v) {
    v("folder", folder,
      "scan_*.ply or scan_*.pcd, and poses.csv and odometry.csv where there are any");
    v("speed", speed, "times real time", 0.01, 1000.0);
    v("loop", loop, "after the last scan comes the first again, at later times");
  }
};

/// A folder of scans as the robot that took them: CLOUD, with ODOMETRY and TRUTH where the folder
/// has them, each with the time of its data.
class ScanSourceService {
 public:
  /// Looks at the folder; scans are read one by one when their time comes. Throws FileError when
  /// the folder makes no sense, or its odometry is of another time than its scans.
  ScanSourceService(bus::Bus& bus, bus::Health& health, const ScanSourceConfig& config);

  /// Throws std::invalid_argument for settings that the constructor would refuse.
  static void check(const ScanSourceConfig& config);

  /// Publishes what is due until now, one scan at most. The first event is due at the first call.
  void tick(std::int64_t now_us);

 private:
  std::int64_t round_us() const;
  bool is_due(std::int64_t now_us) const;
  void advance();
  void publish_odometry(std::size_t row);
  void publish_scan(std::size_t scan);
  void say_how_it_went();

  bus::Bus& bus_;
  bus::Health& health_;
  const ScanSourceConfig config_;
  const io::ScanFolder folder_;
  const std::vector<io::FolderEvent> events_;
  std::size_t next_ = 0;
  std::optional<std::int64_t> start_us_;
  std::int64_t later_us_ = 0;  // than in the files: grows with each round
  std::int32_t clouds_ = 0;
  std::int64_t unreadable_ = 0;
};

}  // namespace voxlist::services
