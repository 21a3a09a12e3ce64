#include "services/mapper/mapper_service.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <voxlist/health_t.hpp>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pointcloud_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/map_convert.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/map_views.h"
#include "voxlist/system/state_folder.h"

namespace voxlist::services {
namespace {

// Clouds that may wait for their localisation: more than the localiser lets wait. Beyond that the
// oldest is forgotten, and a keyframe is missed.
constexpr std::size_t kRecentClouds = 16;

// Time from one save on request to the next (us): the map's picture takes a while, and anyone may
// ask.
constexpr std::int64_t kSavePause_us = 1'000'000;

constexpr std::int64_t kSecond_us = 1'000'000;

// How often the folder is looked at, and what could not be written is tried again: a folder that is
// gone is told within a second.
constexpr std::int64_t kLookPeriod_us = kSecond_us / 2;

// Silence after which another mapper is gone; its HEALTH comes once a second.
constexpr std::int64_t kRivalGone_us = 3 * kSecond_us;

// An id that no other map has: the time when it was begun.
std::int64_t new_map_id() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

std::optional<Pose2> pose_of(const localisation_t& message) {
  if (message.state != localisation_t::STATE_TRACKING || message.modes.empty()) return std::nullopt;
  const double* pose = message.modes.front().pose;
  const bool sane = std::abs(pose[0]) < bus::kMaxPosition_m &&
                    std::abs(pose[1]) < bus::kMaxPosition_m && std::isfinite(pose[2]);
  return sane ? std::optional(Pose2{pose[0], pose[1], wrap_angle(pose[2])}) : std::nullopt;
}

}  // namespace

MapperService::MapperService(bus::Bus& bus, bus::Health& health, const MapperServiceConfig& config)
    : bus_(bus),
      health_(health),
      config_(config),
      builder_(config.builder),
      keyframes_(health, in_state_folder(config.folder), config.extend, new_map_id(),
                 builder_.poses(),
                 [this](mapping::Keyframe keyframe) { restore(std::move(keyframe)); }),
      map_id_(keyframes_.map_id()) {
  bus_.subscribe(bus::kCloud, [this](const pointcloud_t& message) { take_cloud(message); });
  bus_.subscribe(bus::kLocalisation,
                 [this](const localisation_t& message) { take_localisation(message); });
  bus_.subscribe(bus::kMapRequest, [this](const map_request_t& message) { take_request(message); });
  bus_.subscribe(bus::kHealth, [this](const health_t& message) { take_health(message); });
}

void MapperService::restore(mapping::Keyframe keyframe) {
  path_.restore({keyframe.cloud.utime_us, keyframe.T_map_base});
  builder_.add(std::move(keyframe));
}

void MapperService::take_cloud(const pointcloud_t& message) {
  auto received = bus::from_message(message);
  if (!received.cloud) return health_.count("CLOUD/" + received.refusal);
  recent_clouds_.push_back(std::move(*received.cloud));
  if (recent_clouds_.size() > kRecentClouds) recent_clouds_.pop_front();
}

void MapperService::take_localisation(const localisation_t& message) {
  if (message.map_id != map_id_) return health_.count("LOCALISATION/other_map");
  decided_utime_us_ = message.utime;
  const std::int64_t before = version();
  if (const auto pose = pose_of(message)) {
    path_.add({message.utime, *pose});
    if (config_.extend && keyframes_.has_room()) add(message.utime, *pose);
  }
  send_change(before);
}

void MapperService::add(std::int64_t utime_us, const Pose2& pose) {
  const auto cloud = std::find_if(recent_clouds_.begin(), recent_clouds_.end(),
                                  [&](const Cloud& c) { return c.utime_us == utime_us; });
  if (cloud == recent_clouds_.end()) return health_.count("LOCALISATION/cloud_missing");
  if (!builder_.wants(*cloud, pose)) return;
  keyframes_.add(builder_.add({to_pose3(pose), std::move(*cloud)}));
  path_.mark_keyframe();
  recent_clouds_.erase(recent_clouds_.begin(), cloud + 1);
  health_.count("keyframes");
  send_keyframes(keyframes_.size() - 1);
}

void MapperService::take_request(const map_request_t& message) {
  switch (message.want) {
    case map_request_t::WANT_MAP:
      if (whole_maps_queued_ == 0) send_change(bus::kWholeMap);
      return;
    case map_request_t::WANT_KEYFRAMES:
      return resend_keyframes(static_cast<std::size_t>(std::max(0, message.first)));
    case map_request_t::WANT_SAVE:
      save_wanted_ = true;
      return;
    default:
      return health_.count("MAP_REQUEST/unknown_want");
  }
}

void MapperService::send_change(std::int64_t base_version) {
  bus::MapChange change;
  change.utime_us = decided_utime_us_;
  change.map_id = map_id_;
  change.version = version();
  change.base_version = base_version;
  change.resolution = bus::resolution_of(builder_.map());
  if (base_version == bus::kWholeMap) {
    change.blocks = bus::to_messages(builder_.map());
  } else if (base_version != version()) {
    change.blocks = bus::to_messages(builder_.map(), builder_.changed_blocks());
  }
  const bool whole = change.is_whole();
  auto messages = bus::split_map(std::move(change));
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const bool last_of_whole = whole && i + 1 == messages.size();
    auto message = std::make_shared<map_update_t>(std::move(messages[i]));
    const auto bytes = static_cast<std::size_t>(message->getEncodedSize());
    const bool queued = sender_.push(bytes, [this, message, last_of_whole] {
      bus_.publish(bus::kMapUpdate, *message);
      if (last_of_whole) --whole_maps_queued_;
    });
    if (!queued) return health_.count("MAP_UPDATE/queue_full");
    if (last_of_whole) ++whole_maps_queued_;
  }
}

void MapperService::send_keyframes(std::size_t first) {
  for (std::size_t i = first; i < keyframes_.size(); ++i) {
    // The listener asks again for what did not fit.
    if (!sender_.push(keyframes_.bytes(i), [this, i] { send_keyframe(i); }))
      return health_.count("KEYFRAME/queue_full");
  }
}

void MapperService::send_keyframe(std::size_t index) {
  const mapping::Keyframe keyframe = keyframes_.read(index);
  bus_.publish(bus::kKeyframe,
               bus::to_message(bus::PosedCloud{map_id_, static_cast<std::int32_t>(index),
                                               keyframe.T_map_base, keyframe.cloud}));
}

void MapperService::resend_keyframes(std::size_t first) {
  if (resends_queued_ > 0) return health_.count("MAP_REQUEST/already_answering");
  send_keyframes(first);
  if (sender_.push(0, [this] { --resends_queued_; })) ++resends_queued_;
}

void MapperService::take_health(const health_t& message) {
  if (message.service != "mapper" || message.pid == ::getpid()) return;
  rival_heard_us_ = now_us_;
  health_.raise(
      "rival", bus::Health::State::kError,
      fmt::format("another mapper (process {}) is on this bus; stop one of the two", message.pid));
}

void MapperService::tick(std::int64_t now_us) {
  now_us_ = now_us;
  sender_.run(now_us);
  if (save_wanted_ && (!last_save_us_ || now_us - *last_save_us_ >= kSavePause_us)) {
    save_wanted_ = false;
    last_save_us_ = now_us;
    save();
  }
  if (rival_heard_us_ && now_us - *rival_heard_us_ > kRivalGone_us) {
    rival_heard_us_.reset();
    health_.clear("rival");
  }
  if (last_look_us_ && now_us - *last_look_us_ < kLookPeriod_us) return;
  last_look_us_ = now_us;
  keyframes_.look_after();
}

void MapperService::save() {
  keyframes_.look_after();
  const auto folder = keyframes_.folder();
  if (folder.empty()) return;
  views_failed_ = true;
  try {
    mapping::write_map_views(folder, builder_.map().occupied, path_.poses());
    views_failed_ = false;
    health_.count("saved");
    health_.clear("views");
  } catch (const io::FileError& error) {
    health_.count("save_failed");
    health_.raise("views", bus::Health::State::kError, error.what());
  }
}

void MapperService::stop() {
  save();
  if (keyframes_.finish() && !views_failed_) return;
  throw std::runtime_error("the last save failed: " + health_.message());
}

}  // namespace voxlist::services
