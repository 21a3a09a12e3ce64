#include "services/localiser/localiser_service.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_hint_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/maps/map_convert.h"
#include "voxlist/system/memory.h"

namespace voxlist::services {
namespace {

// Points of the first cloud that are farther away (m) do not stand in for the map.
constexpr double kOriginRange_m = 100.0;

// A cloud that fits no map of one cloud waits this long (us) for the next one, and two that fit
// each other for a new map: that takes two answers of the mapper's, and the time in which another
// one may object.
constexpr std::int64_t kUndecided_us = 2'000'000;

// Whether a map can be begun by the cloud: it puts something into it.
bool can_be_origin(const Cloud& cloud) {
  OccupancyMap map;
  add_scan(cloud, Pose3::Identity(), kOriginRange_m, map);
  return !map.empty();
}

localisation_t to_message(const matching::Localisation& result) {
  localisation_t message{};
  message.utime = result.utime_us;
  message.state = static_cast<std::int32_t>(result.state);
  for (const matching::PoseMode& mode : result.modes) {
    pose_mode_t out{};
    bus::write({mode.T_map_base, mode.covariance}, out.pose, out.covariance);
    out.tilt[0] = mode.tilt.z_m;
    out.tilt[1] = mode.tilt.roll_rad;
    out.tilt[2] = mode.tilt.pitch_rad;
    out.overlap = mode.overlap_ratio;
    out.probability = mode.probability;
    message.modes.push_back(out);
  }
  message.n_modes = static_cast<std::int32_t>(message.modes.size());
  message.significance_log10 = result.significance_log10;
  message.confidence = result.confidence;
  message.certified = result.certified;
  message.searched_whole_map = result.searched_whole_map;
  message.poses_examined = result.poses_examined;
  return message;
}

}  // namespace

LocaliserService::LocaliserService(bus::Bus& bus, bus::Health& health,
                                   const LocaliserServiceConfig& config)
    : bus_(bus),
      health_(health),
      config_(config),
      localiser_(map_, config.localiser),
      mapper_(health),
      cloud_input_(health),
      odometry_check_(health, {.channel = "ODOMETRY",
                               .remedy = "is the robot base running?",
                               .is_needed = false,
                               .disorder_us = OdometryBuffer::kMaxAge_us}),
      findings_(health, odometry_check_, config.localiser.tilt),
      pose_output_(bus),
      origin_doubt_(config.localiser) {
  bus_.subscribe(bus::kOdometry, [this](const pose_t& message) { take_odometry(message); });
  bus_.subscribe(bus::kMapUpdate, [this](const map_update_t& message) { take_map(message); });
  bus_.subscribe(bus::kPoseHint, [this](const pose_hint_t& message) { take_hint(message); });
  bus_.subscribe(bus::kCloud, [this](const pointcloud_t& message) { take_cloud(message); });
}

void LocaliserService::check(const LocaliserServiceConfig& config) {
  const OccupancyMap none;
  matching::Localiser(none, config.localiser);
}

void LocaliserService::take_cloud(const pointcloud_t& message) {
  auto cloud = cloud_input_.take(message);
  if (!cloud) return;
  waiting_.push_back({std::move(*cloud), bus_.arrival_utime_us()});
  if (waiting_.size() > static_cast<std::size_t>(config_.max_waiting_clouds)) {
    waiting_.pop_front();
    health_.count("CLOUD/dropped_while_waiting");
    cloud_input_.leave_out(1);
  }
}

void LocaliserService::take_odometry(const pose_t& message) {
  if (!odometry_check_.take(message.utime)) return;
  const auto pose = bus::from_message(message);
  if (!pose) {
    odometry_check_.note("not_a_pose", bus::Health::State::kWarning,
                         "ODOMETRY is no pose: pos must be finite, orientation of length 1");
    return health_.count("ODOMETRY/not_a_pose");
  }
  const StampedPose2 T_odom_base{pose->utime_us, to_pose2(pose->pose)};
  odometry_.add(T_odom_base, tilt_of(pose->pose));
  carry_on(T_odom_base);
}

// While the scans say where the robot is, nobody has to.
void LocaliserService::take_hint(const pose_hint_t& message) {
  const auto pose = bus::from_message(message);
  if (!pose) return health_.count("POSE_HINT/not_a_pose");
  if (message.map_id != 0 && message.map_id != map_id_) return health_.count("POSE_HINT/other_map");
  health_.count(localiser_.hint(*pose) ? "POSE_HINT/taken" : "POSE_HINT/refused");
}

// POSE between clouds.
void LocaliserService::carry_on(const StampedPose2& T_odom_base) {
  const auto pose = pose_output_.at(T_odom_base.pose);
  const auto predicted = localiser_.predict(T_odom_base.utime_us, T_odom_base.pose);
  if (pose && predicted) pose_output_.publish(T_odom_base.utime_us, {*pose, predicted->covariance});
}

void LocaliserService::take_map(const map_update_t& message) {
  for (bus::MapChange& change : mapper_.take(message)) {
    // What the first cloud stood in for is here now.
    if (origin_ && change.base_version == 0) change.base_version = bus::kWholeMap;
    const bus::AppliedChange applied = bus::apply(change, map_);
    if (!applied.replaced) localiser_.map_changed(applied.changed);
    follow_move(change);
    if (change.packed.empty()) continue;
    change.packed.clear();
    give_memory_back();
  }
  follow_mapper();
}

// Who knows one version and not the next does not know where it went.
void LocaliserService::follow_move(const bus::MapChange& change) {
  const std::int64_t before = std::exchange(moves_, change.moves).value_or(change.moves);
  if (change.moves == before) return;
  if (change.moves != before + 1) {
    localiser_.forget();
    return pose_output_.lose();
  }
  localiser_.move(change.T_new_old);
  jump_ = change.T_new_old * jump_.value_or(Pose2{});
}

// Whether or not a map has come: what was made of another one is worth nothing.
void LocaliserService::follow_mapper() {
  if (mapper_.held() && mapper_.held()->version > 0) origin_.reset();
  if (mapper_.map_id() == map_id_) return;
  map_id_ = mapper_.map_id();
  if (!mapper_.held()) map_ = {};
  origin_.reset();
  moves_.reset();
  jump_.reset();
  localiser_.forget();
  pose_output_.lose();
  unanswered_utime_us_.reset();
}

void LocaliserService::tick(std::int64_t now_us) {
  cloud_input_.tick(now_us);
  odometry_check_.tick(now_us);
  if (const auto request = mapper_.tick(now_us)) bus_.publish(bus::kMapRequest, *request);
  follow_mapper();
  health_.gauge("map_voxels", static_cast<double>(map_.occupied.size()));
  health_.gauge("clouds_waiting", static_cast<double>(waiting_.size()));
  if (has_undecided(now_us) || waiting_.empty()) return;
  if (unanswered_utime_us_ && !unanswered_since_us_) unanswered_since_us_ = now_us;
  if (!map_is_due(now_us)) return;
  Waiting waiting = std::move(waiting_.front());
  waiting_.pop_front();
  const std::int64_t arrival_us = waiting.arrival_us;
  decide(localise(std::move(waiting)), now_us);
  health_.add_latency_us(std::max<std::int64_t>(0, now_us - arrival_us));
}

// Whether the map that the waiting cloud is to be matched with is here, or is not worth waiting for
// any longer.
bool LocaliserService::map_is_due(std::int64_t now_us) {
  if (!unanswered_utime_us_) return true;
  if (mapper_.held() && mapper_.held()->utime_us >= *unanswered_utime_us_) return true;
  const std::int64_t waited_us = now_us - unanswered_since_us_.value_or(now_us);
  if (static_cast<double>(waited_us) * 1e-6 < config_.map_wait_s) return false;
  mapper_.doubt();
  return true;
}

LocaliserService::Answer LocaliserService::localise(Waiting waiting) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const std::int64_t utime_us = waiting.cloud.utime_us;
  Answer answer{.waiting = std::move(waiting), .T_odom_base = odometry_.at(utime_us), .found = {}};
  if (!answer.T_odom_base) findings_.tell_missing_odometry(utime_us, odometry_.newest_utime_us());
  if (const auto& held = mapper_.held()) {
    answer.map_id = held->map_id;
    answer.map_version = held->version;
  }
  answer.found = locate(answer.waiting.cloud, answer.T_odom_base);
  answer.elapsed_us =
      std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start).count();
  note_leaving(answer);
  return answer;
}

// Where the robot may be anywhere, what looks like the place that is expected is no more likely
// than another place that does.
void LocaliserService::note_leaving(const Answer& answer) {
  const matching::ScanMoment now{answer.found.utime_us, answer.T_odom_base};
  if (answer.found.tracking())
    placed_ = now;
  else if (placed_ && !matching::is_followed(answer.found) &&
           !matching::is_near(*placed_, now, answer.found, config_.localiser.max_speed_mps)) {
    placed_.reset();
    localiser_.forget();
  }
}

void LocaliserService::decide(Answer answer, std::int64_t now_us) {
  if (!is_first_in_doubt(answer)) {
    publish_undecided();
    return publish(answer);
  }
  pose_output_.lose();
  const Cloud& cloud = answer.waiting.cloud;
  if (!undecided_.empty() && origin_doubt_.fits_it(cloud, answer.T_odom_base)) {
    undecided_.push_back(std::move(answer));
    return ask_for_new_map(now_us);
  }
  publish_undecided();
  if (!origin_doubt_.try_origin(cloud, answer.T_odom_base)) return publish(answer);
  undecided_.push_back(std::move(answer));
  undecided_since_us_ = now_us;
}

// Whether the map is one cloud, which this one does not fit, and that one may be the bad one.
bool LocaliserService::is_first_in_doubt(const Answer& answer) {
  if (!mapper_.held()) return false;
  const bool is_it = origin_ && origin_->utime_us == answer.found.utime_us;
  if (is_it || !origin_doubt_.knows(answer.map_id)) origin_doubt_.begin(answer.map_id, is_it);
  if (is_it) return false;
  if (answer.found.tracking() || answer.map_version > 1) origin_doubt_.end();
  return origin_doubt_.add(answer.found.state);
}

void LocaliserService::ask_for_new_map(std::int64_t now_us) {
  map_request_t request{};
  request.utime = now_us;
  request.want = map_request_t::WANT_NEW_MAP;
  request.map_id = undecided_.front().map_id;
  bus_.publish(bus::kMapRequest, request);
  mapper_.doubt();
  undecided_since_us_ = now_us;
}

// Whether something is to be waited for before the next cloud is matched.
bool LocaliserService::has_undecided(std::int64_t now_us) {
  if (undecided_.empty()) return false;
  const auto& held = mapper_.held();
  if (held && held->map_id != undecided_.front().map_id) {
    for (; !undecided_.empty(); undecided_.pop_back())
      waiting_.push_front(std::move(undecided_.back().waiting));
    return false;
  }
  const bool waits_for_map = undecided_.size() > 1;
  if (now_us - undecided_since_us_ < kUndecided_us) return waits_for_map || waiting_.empty();
  if (waits_for_map) origin_doubt_.postpone();
  publish_undecided();
  return false;
}

void LocaliserService::publish_undecided() {
  for (const Answer& answer : undecided_) publish(answer);
  undecided_.clear();
}

void LocaliserService::publish(const Answer& answer) {
  const matching::Localisation& found = answer.found;
  localisation_t message = to_message(found);
  message.map_id = answer.map_id;
  message.map_version = answer.map_version;
  message.elapsed_us = static_cast<std::int32_t>(answer.elapsed_us);
  findings_.tell(found, mapper_.held().has_value());
  if (jump_) std::ranges::copy(std::array{jump_->x_m, jump_->y_m, jump_->yaw_rad}, message.jump);
  bus_.publish(bus::kLocalisation, message);
  if (jump_) pose_output_.jump(*std::exchange(jump_, std::nullopt));
  unanswered_utime_us_.reset();
  unanswered_since_us_.reset();
  if (found.tracking()) {
    const matching::PoseMode& mode = found.modes.front();
    unanswered_utime_us_ = found.utime_us;
    pose_output_.found({found.utime_us, answer.map_id, answer.map_version},
                       {mode.T_map_base, mode.covariance}, mode.tilt, answer.T_odom_base);
  } else {
    pose_output_.lose();
  }
}

matching::Localisation LocaliserService::locate(const Cloud& cloud,
                                                const std::optional<Pose2>& T_odom_base) {
  const auto& held = mapper_.held();
  if (held && held->version == 0) return locate_without_map(cloud, T_odom_base);
  if (held && !map_.empty())
    return localiser_.localise(cloud, T_odom_base, odometry_.tilt_at(cloud.utime_us));
  matching::Localisation lost;
  lost.utime_us = cloud.utime_us;
  return lost;
}

// The mapper's map is empty: the first cloud is its origin, and the later ones are placed by it.
matching::Localisation LocaliserService::locate_without_map(
    const Cloud& cloud, const std::optional<Pose2>& T_odom_base) {
  matching::Localisation result;
  result.utime_us = cloud.utime_us;
  if (!origin_ && !can_be_origin(cloud)) return result;
  if (origin_ && map_.empty()) add_scan(*origin_, Pose3::Identity(), kOriginRange_m, map_);
  result = localiser_.localise(cloud, T_odom_base, odometry_.tilt_at(cloud.utime_us));
  if (!origin_ && result.tracking()) origin_ = cloud;
  return result;
}

}  // namespace voxlist::services
