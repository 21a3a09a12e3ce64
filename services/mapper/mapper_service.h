#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/bus/paced_sender.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist {
class localisation_t;
class map_request_t;
class pointcloud_t;
}  // namespace voxlist

namespace voxlist::bus {
class Bus;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// Settings of the mapper.
struct MapperServiceConfig {
  std::string folder = "map";
  bool extend = true;
  double save_period_s = 10.0;
  mapping::MapBuilderConfig builder;

  template <class Visitor>
  void visit(Visitor& v) {
    v("folder", folder,
      "where the map is kept, in the state folder if relative; loaded at start when it holds one; "
      "empty: in memory alone");
    v("extend", extend, "add clouds to the map; false: only serve the map that is there");
    v("save_period_s", save_period_s, "how often what was added is synced to the disk", 0.1,
      3600.0);
    builder.visit(v);
  }
};

/// CLOUD, LOCALISATION and MAP_REQUEST in; MAP_UPDATE and KEYFRAME out; the map folder on disk.
///
/// Each LOCALISATION is answered by a MAP_UPDATE, an empty one when nothing was added: the
/// localiser waits for it. Each keyframe goes to disk at once, so that kill -9 loses none; a disk
/// that is full is an error in HEALTH, and what could not be written is kept and tried again.
class MapperService {
 public:
  /// Loads the folder's map. Throws FileError when there is one that cannot be read or no folder
  /// can be made.
  MapperService(bus::Bus& bus, bus::Health& health, const MapperServiceConfig& config);

  /// Sends what is queued, as fast as listeners can take it, and syncs the disk when it is time.
  void tick(std::int64_t now_us);

  /// Writes the map's views (picture, points, trajectory) and syncs.
  void stop();

 private:
  void take_cloud(const pointcloud_t& message);
  void take_localisation(const localisation_t& message);
  void take_request(const map_request_t& message);
  void load();
  void add(std::int64_t utime_us, const Pose2& pose);
  void send_change(std::int64_t base_version);
  void send_keyframes(std::size_t first);
  void resend_keyframes(std::size_t first);
  void store_keyframes();
  void sync();
  void save();
  std::int64_t version() const { return static_cast<std::int64_t>(builder_.keyframes().size()); }

  bus::Bus& bus_;
  bus::Health& health_;
  const MapperServiceConfig config_;
  const std::filesystem::path folder_;
  mapping::MapBuilder builder_;
  std::int64_t map_id_ = 0;
  std::unique_ptr<mapping::MapStore> store_;
  std::size_t stored_ = 0;  // keyframes that were appended to the store
  std::size_t synced_ = 0;  // keyframes that would survive a power cut
  std::vector<StampedPose3> trajectory_;
  std::deque<Cloud> recent_clouds_;
  bus::PacedSender sender_;
  std::int64_t decided_utime_us_ = 0;
  // Requests are answered one at a time, whoever asks and however often.
  std::int64_t whole_maps_queued_ = 0;
  std::int64_t resends_queued_ = 0;
  bool save_wanted_ = false;
  std::optional<std::int64_t> last_save_us_;
  std::optional<std::int64_t> last_sync_us_;
};

}  // namespace voxlist::services
