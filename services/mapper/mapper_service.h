#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "services/mapper/apart/apart_session.h"
#include "services/mapper/edit_channel.h"
#include "services/mapper/keyframe_keeper.h"
#include "services/mapper/loops/loop_keeper.h"
#include "services/mapper/map_channel.h"
#include "services/mapper/travelled_path.h"
#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/bus/multicast/paced_sender.h"
#include "voxlist/geometry/odometry_buffer.h"
#include "voxlist/geometry/tilt.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/service/inputs/cloud_input.h"

namespace voxlist {
class health_t;
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
  TiltUse tilt = TiltUse::kPlanar;
  double max_speed_mps = matching::LocaliserConfig{}.max_speed_mps;
  double max_turn_rate_dps = matching::LocaliserConfig{}.max_turn_rate_dps;
  LoopUse close_loops = LoopUse::kOnStop;
  double last_loops_s = 5.0;
  mapping::MapBuilderConfig builder;

  template <class Visitor>
  void visit(Visitor& v) {
    v("folder", folder,
      "where the map is kept, in the state folder if relative; loaded at start when it holds one; "
      "empty: in memory alone");
    v("extend", extend,
      "add clouds to the map; false: only serve the map that is there, and write nothing");
    v("tilt", tilt, kTiltNames,
      "as in [localiser]. planar: clouds whose pose has height, roll or pitch stay out of the map; "
      "refine, odometry: they go into it as they are");
    v("max_speed_mps", max_speed_mps,
      "as in [localiser]: when the robot has left the map, and how pieces apart are tracked", 0.01,
      50.0);
    v("max_turn_rate_dps", max_turn_rate_dps, "as in [localiser], for pieces apart", 1.0, 720.0);
    v("close_loops", close_loops, kLoopUseNames,
      "where the robot came back to, keyframes move to where all scans agree. always: while it "
      "drives, too, so that POSE jumps; on_stop: the map is then the one that voxlist map makes of "
      "the same recording; never");
    v("last_loops_s", last_loops_s,
      "how long the mapper goes on closing loops, once it is to stop (s); what it does not get to "
      "is done at its next stop, or by voxlist extend",
      0.0, 50.0);
    builder.visit(v);
  }
};

/// CLOUD, LOCALISATION and MAP_REQUEST in; MAP_UPDATE, FREE_SPACE and KEYFRAME out; the map
/// folder on disk.
///
/// Each LOCALISATION is answered by a MAP_UPDATE, an empty one when nothing was added: the
/// localiser waits for it. A pose counts only when it was found in the map as it is: of this id and
/// version. Each request is answered by the map's id and version, which are also told at the start
/// and to who speaks of another map. Each keyframe goes to disk at once, so that neither kill -9
/// nor a power cut loses one; a disk that is full is an error in HEALTH until what could not be
/// written is. A map whose only cloud no other fits is given up when it is asked for. A folder that
/// vanishes costs nothing either: the map goes on in a fresh one beside it. Where the robot came
/// back to ground of long before, keyframes move to where all scans agree: a new version of the
/// map, which goes out as a change once it is whole and the graph is on the disk. So does an edit
/// by hand (MAP_EDIT), once it is on the disk. Where the robot has left the map, mapping goes on
/// apart, until that has its place in the map.
class MapperService {
 public:
  /// Loads the folder's map. Throws FileError when there is one that cannot be read, when no folder
  /// can be made, and when another mapper works in it.
  MapperService(bus::Bus& bus, bus::Health& health, const MapperServiceConfig& config);

  /// Sends what is queued, as fast as listeners can take it, looks after the folder, and tries
  /// again what could not be written.
  void tick(std::int64_t now_us);

  /// Writes the map's views (picture, points, trajectory). Throws std::runtime_error when something
  /// of the map could not be written.
  void stop();

 private:
  void take_cloud(const pointcloud_t& message);
  void take_localisation(const localisation_t& message);
  void take_request(const map_request_t& message);
  void give_up(std::int64_t map_id);
  void set_extending(bool wanted);
  void take_health(const health_t& message);
  void decide(const localisation_t& message);
  void confirm();
  bool takes(const Tilt& tilt);
  void join_apart(int at_most);
  void add(Cloud cloud, const Pose3& pose, const std::optional<Pose2>& T_odom_base);
  void recall_graph();
  void move(ClosedMap closed);
  std::string edit(const bus::EditWish& wish);
  bus::EditedBoxes edited_boxes() const;
  std::optional<Cloud> take_waiting_cloud(std::int64_t utime_us);
  void send_change(std::int64_t base_version);
  void send_map_change(std::int64_t base_version);
  void send_free_space_change(std::int64_t base_version);
  void send_word(std::int64_t answers);
  void answer_for_free_space(const map_request_t& message);
  bus::MapChange nothing_new(const OccupancyMap& map) const;
  bus::MapChange change_of(std::int64_t base_version, const OccupancyMap& map,
                           const ChangedBlocks& changed) const;
  bool has_use_for_map(const map_request_t& message) const;
  void send_keyframes(std::size_t first, std::size_t at_most);
  void resend_keyframes(std::size_t first);
  void send_keyframe(std::size_t index);
  void save();
  void save_on_request();
  std::int64_t version() const {
    return std::ssize(builder_.poses()) + moves_ + keyframes_.edits().changes;
  }

  bus::Bus& bus_;
  bus::Health& health_;
  const MapperServiceConfig config_;
  mapping::MapBuilder builder_;
  TravelledPath path_;
  KeyframeKeeper keyframes_;
  OdometryBuffer odometry_;
  LoopKeeper loops_;
  ApartSession apart_;
  std::int64_t moves_ = 0;
  drawing::ClosedLoops closed_loops_;  // those of the last move
  Pose2 T_new_old_;                    // how the newest keyframe was moved the last time
  std::int64_t map_id_;
  bool is_extending_;          // clouds go into the map
  bool is_confirmed_ = false;  // a cloud was placed by what the map's first one saw
  service::CloudInput cloud_input_;
  std::deque<Cloud> recent_clouds_;
  // Bytes on the bus: what waits of a whole map takes half of them, of keyframes none.
  bus::PacedSender sender_{bus::PacedSender::Options{.max_queued_bytes = 1'200'000'000}};
  MapChannel map_channel_, free_channel_;
  EditChannel edit_channel_;
  bool is_free_space_wanted_ = false;
  std::int64_t decided_utime_us_ = 0;
  // Requests are answered one at a time, whoever asks and however often.
  std::int64_t resends_queued_ = 0;
  bool save_wanted_ = false;
  std::optional<std::int64_t> next_save_us_;
  std::optional<std::int64_t> arrival_us_;  // of what was handled since the last tick
  std::optional<std::int64_t> last_announced_us_;
  std::int64_t now_us_ = 0;
  std::optional<std::int64_t> last_look_us_;
  std::optional<std::int64_t> rival_heard_us_;
  bool views_failed_ = false;
};

}  // namespace voxlist::services
