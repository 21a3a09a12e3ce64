#include "services/mapper/mapper_service.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
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

// Bytes of a point on its way in KEYFRAME: three floats, and three of its ray's origin.
constexpr std::size_t kPointBytes = 24;

// Time from one save on request to the next (us): the map's picture takes a while, and anyone may
// ask.
constexpr std::int64_t kSavePause_us = 1'000'000;

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
      folder_(in_state_folder(config.folder)),
      builder_(config.builder),
      map_id_(new_map_id()) {
  load();
  bus_.subscribe(bus::kCloud, [this](const pointcloud_t& message) { take_cloud(message); });
  bus_.subscribe(bus::kLocalisation,
                 [this](const localisation_t& message) { take_localisation(message); });
  bus_.subscribe(bus::kMapRequest, [this](const map_request_t& message) { take_request(message); });
}

void MapperService::load() {
  if (folder_.empty()) return;
  if (!std::filesystem::exists(folder_ / mapping::kKeyframeFile)) {
    store_ = std::make_unique<mapping::MapStore>(folder_, map_id_, builder_.keyframes());
    return;
  }
  mapping::StoredMap stored = mapping::load_map(folder_);
  map_id_ = stored.map_id;
  for (mapping::Keyframe& keyframe : stored.keyframes) {
    trajectory_.push_back({keyframe.cloud.utime_us, keyframe.T_map_base});
    builder_.add(std::move(keyframe));
  }
  stored_ = builder_.keyframes().size();
  if (stored.warning.empty()) {
    store_ = std::make_unique<mapping::MapStore>(folder_);
  } else {
    // What is damaged is kept aside, for whoever wants to look.
    std::filesystem::copy_file(folder_ / mapping::kKeyframeFile,
                               folder_ / (std::string(mapping::kKeyframeFile) + ".damaged"),
                               std::filesystem::copy_options::overwrite_existing);
    store_ = std::make_unique<mapping::MapStore>(folder_, map_id_, builder_.keyframes());
    health_.raise("damage", bus::Health::State::kWarning, stored.warning);
  }
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
    trajectory_.push_back({message.utime, to_pose3(*pose)});
    if (config_.extend && builder_.wants(*pose)) add(message.utime, *pose);
  }
  send_change(before);
}

void MapperService::add(std::int64_t utime_us, const Pose2& pose) {
  const auto cloud = std::find_if(recent_clouds_.begin(), recent_clouds_.end(),
                                  [&](const Cloud& c) { return c.utime_us == utime_us; });
  if (cloud == recent_clouds_.end()) return health_.count("LOCALISATION/cloud_missing");
  builder_.add({to_pose3(pose), std::move(*cloud)});
  recent_clouds_.erase(recent_clouds_.begin(), cloud + 1);
  health_.count("keyframes");
  store_keyframes();
  send_keyframes(builder_.keyframes().size() - 1);
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
  for (std::size_t i = first; i < builder_.keyframes().size(); ++i) {
    const mapping::Keyframe& keyframe = builder_.keyframes()[i];
    const std::size_t bytes = kPointBytes * keyframe.cloud.points.size();
    const bool queued = sender_.push(bytes, [this, i] {
      const mapping::Keyframe& k = builder_.keyframes()[i];
      bus_.publish(bus::kKeyframe,
                   bus::to_message(bus::PosedCloud{map_id_, static_cast<std::int32_t>(i),
                                                   k.T_map_base, k.cloud}));
    });
    // The listener asks again for what did not fit.
    if (!queued) return health_.count("KEYFRAME/queue_full");
  }
}

void MapperService::resend_keyframes(std::size_t first) {
  if (resends_queued_ > 0) return health_.count("MAP_REQUEST/already_answering");
  send_keyframes(first);
  if (sender_.push(0, [this] { --resends_queued_; })) ++resends_queued_;
}

void MapperService::store_keyframes() {
  if (!store_) return;
  try {
    for (; stored_ < builder_.keyframes().size(); ++stored_)
      store_->append(builder_.keyframes()[stored_]);
    health_.clear("append");
  } catch (const io::FileError& error) {
    health_.count("save_failed");
    health_.raise("append", bus::Health::State::kError, error.what());
  }
}

void MapperService::tick(std::int64_t now_us) {
  sender_.run(now_us);
  if (save_wanted_ && (!last_save_us_ || now_us - *last_save_us_ >= kSavePause_us)) {
    save_wanted_ = false;
    last_save_us_ = now_us;
    save();
  }
  if (!last_sync_us_) last_sync_us_ = now_us;
  if (static_cast<double>(now_us - *last_sync_us_) * 1e-6 < config_.save_period_s) return;
  last_sync_us_ = now_us;
  if (stored_ < builder_.keyframes().size()) store_keyframes();
  sync();
}

void MapperService::sync() {
  if (!store_ || synced_ == stored_) return;
  try {
    store_->sync();
    synced_ = stored_;
    health_.clear("sync");
  } catch (const io::FileError& error) {
    health_.count("save_failed");
    health_.raise("sync", bus::Health::State::kError, error.what());
  }
}

void MapperService::save() {
  if (!store_) return;
  store_keyframes();
  sync();
  try {
    mapping::write_map_views(folder_, builder_.map().occupied, trajectory_);
    health_.count("saved");
    health_.clear("views");
  } catch (const io::FileError& error) {
    health_.count("save_failed");
    health_.raise("views", bus::Health::State::kError, error.what());
  }
}

void MapperService::stop() { save(); }

}  // namespace voxlist::services
