#include "services/mapper/mapper_service.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <voxlist/health_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/mapper/told.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/map_views.h"
#include "voxlist/system/state_folder.h"

namespace voxlist::services {
namespace {

// Clouds that may wait for their localisation: more than the localiser lets wait. Beyond that the
// oldest is forgotten, and a keyframe is missed.
constexpr std::size_t kRecentClouds = 16;

constexpr std::int64_t kSecond_us = 1'000'000;

// Time from one save on request to the next (us), or this many times what the last one took: the
// map's picture takes a while, and anyone may ask.
constexpr std::int64_t kSavePause_us = kSecond_us;
constexpr std::int64_t kSaveShare = 10;

// Who speaks of another map is told of this one so often at most (us).
constexpr std::int64_t kAnnouncePause_us = kSecond_us / 10;

// How often the folder is looked at, and what could not be written is tried again: a folder that is
// gone is told within a second.
constexpr std::int64_t kLookPeriod_us = kSecond_us / 2;

// Silence after which another mapper is gone; its HEALTH comes once a second.
constexpr std::int64_t kRivalGone_us = 3 * kSecond_us;

// Clouds that were apart and get their place after each cloud.
constexpr int kApartAtOnce = 4;

// An id that no other map has: the time when it was begun.
std::int64_t new_map_id() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

mapping::MapBuilderConfig with_free_space(mapping::MapBuilderConfig config) {
  config.count_free = true;
  return config;
}

// What tracks pieces apart, on one thread: the robot's other services go on beside it.
matching::LocaliserConfig localiser_of(const MapperServiceConfig& config) {
  matching::LocaliserConfig localiser;
  localiser.max_speed_mps = config.max_speed_mps;
  localiser.max_turn_rate_dps = config.max_turn_rate_dps;
  localiser.tilt = config.tilt;
  localiser.threads = 1;
  return localiser;
}

}  // namespace

MapperService::MapperService(bus::Bus& bus, bus::Health& health, const MapperServiceConfig& config)
    : bus_(bus),
      health_(health),
      config_(config),
      builder_(with_free_space(config.builder)),
      keyframes_(health, in_state_folder(config.folder), config.extend, new_map_id(), builder_),
      loops_(health, config.close_loops, with_free_space(config.builder)),
      apart_(health, keyframes_.folder(), !builder_.poses().empty(), localiser_of(config),
             config.builder),
      moves_(keyframes_.moves()),
      map_id_(keyframes_.map_id()),
      is_extending_(config.extend),
      cloud_input_(health),
      map_channel_(bus, health, sender_, bus::kMapUpdate),
      free_channel_(bus, health, sender_, bus::kFreeSpace),
      edit_channel_(bus, health, sender_) {
  builder_.edit(keyframes_.edits());
  for (const StampedPose3& keyframe : builder_.poses()) path_.restore(keyframe);
  recall_graph();
  bus_.subscribe(bus::kCloud, [this](const pointcloud_t& message) { take_cloud(message); });
  bus_.subscribe(bus::kLocalisation,
                 [this](const localisation_t& message) { take_localisation(message); });
  bus_.subscribe(bus::kOdometry, [this](const pose_t& message) {
    if (const auto pose = bus::from_message(message))
      odometry_.add({pose->utime_us, to_pose2(pose->pose)});
  });
  bus_.subscribe(bus::kMapRequest, [this](const map_request_t& message) { take_request(message); });
  bus_.subscribe(bus::kHealth, [this](const health_t& message) { take_health(message); });
}

void MapperService::take_cloud(const pointcloud_t& message) {
  auto cloud = cloud_input_.take(message);
  if (!cloud) return;
  recent_clouds_.push_back(std::move(*cloud));
  if (recent_clouds_.size() > kRecentClouds) recent_clouds_.pop_front();
}

void MapperService::take_localisation(const localisation_t& message) {
  if (!bus::is_sane_utime(message.utime)) return health_.count("LOCALISATION/bad_utime");
  if (message.map_id != map_id_) {
    health_.count("LOCALISATION/other_map");
    if (last_announced_us_ && now_us_ - *last_announced_us_ < kAnnouncePause_us) return;
    last_announced_us_ = now_us_;
    return send_word(0);
  }
  decided_utime_us_ = message.utime;
  const std::int64_t before = version();
  decide(message);
  send_change(before);
  join_apart(kApartAtOnce);
  arrival_us_ = bus_.arrival_utime_us();
}

// A cloud is decided on once: who speaks of it again, and otherwise, is not heard.
void MapperService::decide(const localisation_t& message) {
  if (message.map_version != version()) return health_.count("LOCALISATION/other_version");
  auto cloud = take_waiting_cloud(message.utime);
  const auto pose = pose_of(message);
  if (!pose) {
    if (cloud && is_extending_) apart_.lost(*cloud, odometry_.at(message.utime), told(message));
    return;
  }
  if (version() > 0) confirm();
  if (!takes(pose->tilt)) return;
  path_.add({message.utime, pose->planar}, pose->tilt);
  if (cloud) apart_.found(*cloud, odometry_.at(message.utime), told(message));
  if (!is_extending_ || !keyframes_.has_room()) return;
  if (!cloud) return health_.count("LOCALISATION/cloud_missing");
  if (builder_.wants(*cloud, pose->planar, pose->tilt)) {
    add(std::move(*cloud), to_pose3(pose->planar, pose->tilt), odometry_.at(message.utime));
    path_.mark_keyframe();
  }
}

// Each is a version of its own: the next one is matched with it.
void MapperService::join_apart(int at_most) {
  for (int i = 0; i < at_most && is_extending_ && keyframes_.has_room(); ++i) {
    auto placed = apart_.place_next();
    if (!placed) return;
    if (!builder_.wants(placed->cloud, to_pose2(placed->pose), tilt_of(placed->pose))) continue;
    const std::int64_t before = version();
    path_.restore({placed->cloud.utime_us, placed->pose});
    add(std::move(placed->cloud), placed->pose, placed->T_odom_base);
    send_change(before);
  }
}

// A map of level clouds is spoilt by one that is not.
bool MapperService::takes(const Tilt& tilt) {
  if (config_.tilt != TiltUse::kPlanar || tilt == Tilt{}) return true;
  health_.count("LOCALISATION/tilted");
  health_.raise("tilt", bus::Health::State::kWarning,
                "LOCALISATION tells height, roll and pitch, which are not mapped: set tilt in "
                "[mapper] as in [localiser]");
  return false;
}

void MapperService::confirm() {
  is_confirmed_ = true;
  health_.clear("given_up");
}

// Those before it are not decided on any more.
std::optional<Cloud> MapperService::take_waiting_cloud(std::int64_t utime_us) {
  const auto found = std::ranges::find(recent_clouds_, utime_us, &Cloud::utime_us);
  if (found == recent_clouds_.end()) return std::nullopt;
  Cloud cloud = std::move(*found);
  recent_clouds_.erase(recent_clouds_.begin(), found + 1);
  return cloud;
}

void MapperService::add(Cloud cloud, const Pose3& pose, const std::optional<Pose2>& T_odom_base) {
  keyframes_.add(builder_.add({pose, std::move(cloud)}));
  const StampedPose3& newest = builder_.poses().back();
  loops_.add(newest, T_odom_base);
  health_.count("keyframes");
  send_keyframes(keyframes_.size() - 1, 1);
}

// What the graph of before knows beside the poses: odometry.
void MapperService::recall_graph() {
  const auto folder = keyframes_.folder();
  if (folder.empty()) return;
  const auto found = mapping::find_graph(folder, keyframes_.map_id());
  mapping::GraphPoses known(found.graph ? found.graph->keyframes : mapping::MapKeyframes{});
  for (const StampedPose3& pose : builder_.poses()) {
    auto keyframe =
        known.next(pose.utime_us)
            .value_or(mapping::StoredGraph::Keyframe{pose.utime_us, to_pose2(pose.pose)});
    keyframe.tilt = tilt_of(pose.pose);
    loops_.restore(keyframe);
  }
  if (is_extending_) loops_.keep_looks(folder, map_id_);
}

// On the disk first: a mapper that is started again goes on with what listeners have.
void MapperService::move(ClosedMap closed) {
  if (!keyframes_.write_graph({map_id_, moves_ + 1, closed.keyframes, closed.edges})) return;
  const std::int64_t before = version();
  const std::vector<StampedPose3> poses = builder_.poses();
  builder_.move_to(std::move(closed.builder), closed.T_new_old);
  path_.move(poses, builder_.poses());
  apart_.move(closed.T_new_old);
  loops_.accept(std::move(closed.keyframes));
  ++moves_;
  T_new_old_ = closed.T_new_old;
  closed_loops_ = std::move(closed.drawn);
  health_.count("maps_moved");
  send_change(before);
  if (!keyframes_.edits().edits.empty()) edit_channel_.tell(edited_boxes(), 0);
}

// Only a map that is next to nothing: whoever asks, no more than one cloud is lost.
void MapperService::give_up(std::int64_t map_id) {
  const bool is_of_one = version() <= 1 && !is_confirmed_;
  const std::int64_t new_id = std::max(new_map_id(), map_id_ + 1);
  if (!is_extending_ || map_id != map_id_ || !is_of_one || !keyframes_.begin_anew(new_id))
    return health_.count("MAP_REQUEST/new_map_refused");
  map_id_ = new_id;
  builder_.clear();
  loops_.clear();
  if (!keyframes_.folder().empty()) loops_.keep_looks(keyframes_.folder(), map_id_);
  moves_ = 0;
  closed_loops_ = {};
  path_ = {};
  sender_.clear();
  resends_queued_ = 0;
  map_channel_.clear();
  free_channel_.clear();
  edit_channel_.clear();
  health_.count("maps_given_up");
  health_.raise("given_up", bus::Health::State::kWarning,
                "the map's first cloud was given up, as no other fits it: was something before the "
                "scanner?");
}

void MapperService::take_health(const health_t& message) {
  if (message.service != "mapper" || message.pid == ::getpid()) return;
  rival_heard_us_ = now_us_;
  health_.raise(
      "rival", bus::Health::State::kError,
      fmt::format("another mapper (process {}) is on this bus; stop one of the two", message.pid));
}

void MapperService::tick(std::int64_t now_us) {
  if (now_us_ == 0) send_word(0);  // whoever has another map drops it
  now_us_ = now_us;
  if (arrival_us_) health_.add_latency_us(now_us - *arrival_us_);
  arrival_us_.reset();
  cloud_input_.tick(now_us);
  edit_channel_.tick(
      now_us, [this](const bus::EditWish& wish) { return edit(wish); },
      [this] { return edited_boxes(); });
  sender_.run(now_us);
  if (is_extending_)
    if (auto closed = loops_.tick(now_us, [this] { return keyframes_.open_again(); }))
      move(std::move(*closed));
  if (save_wanted_ && (!next_save_us_ || now_us >= *next_save_us_)) save_on_request();
  if (rival_heard_us_ && now_us - *rival_heard_us_ > kRivalGone_us) {
    rival_heard_us_.reset();
    health_.clear("rival");
  }
  if (last_look_us_ && now_us - *last_look_us_ < kLookPeriod_us) return;
  last_look_us_ = now_us;
  keyframes_.look_after();
  health_.gauge("map_voxels", static_cast<double>(builder_.map().occupied.size()));
  health_.gauge("map_queue_MB", static_cast<double>(sender_.queued_bytes()) * 1e-6);
}

void MapperService::save_on_request() {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  save_wanted_ = false;
  save();
  const std::chrono::microseconds took =
      std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start);
  next_save_us_ = now_us_ + std::max(kSavePause_us, kSaveShare * took.count());
}

void MapperService::save() {
  keyframes_.look_after();
  const auto folder = keyframes_.folder();
  if (folder.empty()) return;
  views_failed_ = true;
  try {
    keyframes_.write_built();
    mapping::write_map_views(folder, builder_.map(), path_.poses(), closed_loops_);
    views_failed_ = false;
    health_.count("saved");
    health_.clear("views");
  } catch (const io::FileError& error) {
    health_.count("save_failed");
    health_.raise("views", bus::Health::State::kError, error.what());
  }
}

void MapperService::stop() {
  join_apart(std::numeric_limits<int>::max());
  while (is_extending_)
    if (auto closed =
            loops_.finish([this] { return keyframes_.open_again(); }, config_.last_loops_s))
      move(std::move(*closed));
    else
      break;
  save();
  if (keyframes_.finish() && !views_failed_) return;
  throw std::runtime_error("the last save failed: " + health_.message());
}

}  // namespace voxlist::services
