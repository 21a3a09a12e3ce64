#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "services/localiser/findings_in_health.h"
#include "services/localiser/origin_doubt.h"
#include "services/localiser/pose_output.h"
#include "voxlist/geometry/odometry_buffer.h"
#include "voxlist/matching/localisation/leaving.h"
#include "voxlist/matching/localisation/localiser.h"
#include "voxlist/service/inputs/cloud_input.h"
#include "voxlist/service/inputs/map_follower.h"

namespace voxlist {
class map_update_t;
class pose_hint_t;
class pose_t;
class pointcloud_t;
}  // namespace voxlist

namespace voxlist::bus {
class Bus;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// Settings of the localiser.
struct LocaliserServiceConfig {
  double map_wait_s = 0.5;
  int max_waiting_clouds = 3;
  matching::LocaliserConfig localiser;

  template <class Visitor>
  void visit(Visitor& v) {
    v("map_wait_s", map_wait_s,
      "longest wait for the mapper's word on the last cloud before the next is matched", 0.0, 10.0);
    v("max_waiting_clouds", max_waiting_clouds,
      "clouds that may wait; then the oldest is dropped. 1: always the newest, for maps that are "
      "there; more: a busy second leaves no hole in a new one",
      1, 100);
    localiser.visit(v);
  }
};

/// CLOUD, ODOMETRY, MAP_UPDATE and POSE_HINT in; POSE, POSE_COVARIANCE, T_MAP_ODOM,
/// LOCALISATION and MAP_REQUEST out.
///
/// A cloud waits until the mapper has decided on the cloud before it (bounded by map_wait_s): so a
/// run gives the same map as its replay, and as the desk tool. A few clouds may wait; beyond that
/// the oldest is dropped and counted.
///
/// Where the mapper says that its map is empty, the first cloud is the map's origin, and no other
/// is while that map lives: until the mapper has it, it stands in for the map. Where two later
/// clouds fit each other but not that one, the mapper is asked for a new map, and the two begin it;
/// so what does not fit a map of one cloud is answered when the next one is there.
class LocaliserService {
 public:
  LocaliserService(bus::Bus& bus, bus::Health& health, const LocaliserServiceConfig& config);

  /// Throws std::invalid_argument for an engine that there is not.
  static void check(const LocaliserServiceConfig& config);

  /// Matches the waiting cloud when its turn has come, and asks for the map when one is missing.
  void tick(std::int64_t now_us);

 private:
  struct Waiting {
    Cloud cloud;
    std::int64_t arrival_us;
  };

  // A cloud with what is known of it.
  struct Answer {
    Waiting waiting;
    std::optional<Pose2> T_odom_base;
    matching::Localisation found;
    std::int64_t map_id = 0, map_version = 0;
    std::int64_t elapsed_us = 0;
  };

  void take_cloud(const pointcloud_t& message);
  void take_odometry(const pose_t& message);
  void carry_on(const StampedPose2& T_odom_base);
  void take_hint(const pose_hint_t& message);
  void take_map(const map_update_t& message);
  void follow_mapper();
  void follow_move(const bus::MapChange& change);
  bool map_is_due(std::int64_t now_us);
  Answer localise(Waiting waiting);
  void note_leaving(const Answer& answer);
  void decide(Answer answer, std::int64_t now_us);
  bool is_first_in_doubt(const Answer& answer);
  bool has_undecided(std::int64_t now_us);
  void ask_for_new_map(std::int64_t now_us);
  void publish_undecided();
  void publish(const Answer& answer);
  matching::Localisation locate(const Cloud& cloud, const std::optional<Pose2>& T_odom_base);
  matching::Localisation locate_without_map(const Cloud& cloud,
                                            const std::optional<Pose2>& T_odom_base);

  bus::Bus& bus_;
  bus::Health& health_;
  const LocaliserServiceConfig config_;
  OccupancyMap map_;
  matching::Localiser localiser_;
  service::MapFollower mapper_;
  std::optional<std::int64_t> map_id_;  // of the map that map_ is of
  std::optional<std::int64_t> moves_;   // how often its keyframes were moved
  std::optional<Pose2> jump_;           // by which POSE will jump, and nobody was told yet
  std::optional<Cloud> origin_;         // the cloud that defined the origin of an empty map
  service::CloudInput cloud_input_;
  service::ChannelCheck odometry_check_;
  FindingsInHealth findings_;
  OdometryBuffer odometry_;
  std::deque<Waiting> waiting_;                 // oldest first
  std::optional<matching::ScanMoment> placed_;  // the last cloud that was, until the map is left
  // The last cloud that the mapper may have added, and since when its answer is awaited.
  std::optional<std::int64_t> unanswered_utime_us_;
  std::optional<std::int64_t> unanswered_since_us_;
  PoseOutput pose_output_;
  OriginDoubt origin_doubt_;
  // What does not fit a map of one cloud: one waits for the next cloud, two for a new map.
  std::vector<Answer> undecided_;
  std::int64_t undecided_since_us_ = 0;
};

}  // namespace voxlist::services
