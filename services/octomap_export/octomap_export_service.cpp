#include "services/octomap_export/octomap_export_service.h"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <utility>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/map_octree_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/health.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/service/stop.h"
#include "voxlist/system/state_folder.h"

namespace voxlist::services {
namespace {

constexpr std::int64_t kSecond_us = 1'000'000;

// Missing keyframes are asked for this often at most: an answer takes time.
constexpr std::int64_t kAskPeriod_us = kSecond_us;

// OCTOMAP goes out this often at most: a large one takes a while to write and to read.
constexpr std::int64_t kPublishPeriod_us = kSecond_us;

class Stopwatch {
 public:
  std::int64_t elapsed_us() const {
    return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start_ = Clock::now();
};

std::string reach_sentence(double reach_m) {
  if (std::isinf(reach_m)) return {};
  return fmt::format(
      "a cloud's rays pass too many voxels and free only {:.0f} m of their way: "
      "set a larger resolution_m",
      reach_m);
}

}  // namespace

OctomapExportService::OctomapExportService(bus::Bus& bus, bus::Health& health,
                                           const OctomapExportConfig& config)
    : bus_(bus),
      health_(health),
      config_(config),
      folder_(in_state_folder(config.folder)),
      builder_(config.octomap) {
  if (!folder_.empty()) io::remove_stale_temporaries(folder_);
  bus_.subscribe(bus::kKeyframe, [this](const keyframe_t& m) { take(m); });
  bus_.subscribe(bus::kMapUpdate, [this](const map_update_t& m) { take_word(m); });
}

// Only what answers its own request is believed: MAP_UPDATE is open to whoever publishes on it.
void OctomapExportService::take_word(const map_update_t& message) {
  if (request_us_ == 0 || message.answers != request_us_) return;
  if (message.version < 0 || message.version > std::numeric_limits<std::int32_t>::max()) return;
  has_word_ = true;
  queue_.know_of(message.map_id, static_cast<std::int32_t>(message.version));
}

void OctomapExportService::take(const keyframe_t& message) {
  auto keyframe = bus::from_message(message);
  if (!keyframe) return health_.count("KEYFRAME/refused");
  using Verdict = KeyframeQueue::Verdict;
  const Verdict verdict = queue_.add(std::move(*keyframe));
  if (verdict == Verdict::kRepeated) health_.count("KEYFRAME/repeated");
  if (verdict == Verdict::kDroppedOne) health_.count("KEYFRAME/queue_full");
}

void OctomapExportService::tick(std::int64_t now_us) {
  if (const auto keyframe = queue_.next()) {
    insert(*keyframe);
    quiet_since_us_ = now_us;
  }
  if (const auto first = missing()) ask(*first, now_us);
  if (publishing_.due(now_us, kPublishPeriod_us)) publish(now_us);
  // While it catches up, a file of an earlier run holds more than it does: the first period starts
  // with the service, and none ends before everything is in.
  if (!saving_.last_us) saving_.last_us = now_us;
  const auto save_period_us = static_cast<std::int64_t>(config_.save_period_s * kSecond_us);
  if (save_period_us > 0 && queue_.is_done() && saving_.due(now_us, save_period_us)) save(now_us);
  report();
}

void OctomapExportService::stop() {
  if (!saving_.changed) return;
  save(0);
  if (!save_error_.empty()) throw std::runtime_error("the last save failed: " + save_error_);
}

void OctomapExportService::insert(const bus::PosedCloud& keyframe) {
  if (keyframe.index == 0) builder_ = planning::OctomapBuilder(config_.octomap);
  builder_.insert(keyframe.T_map_base, keyframe.cloud, service::stop_requested);
  map_id_ = keyframe.map_id;
  utime_us_ = keyframe.cloud.utime_us;
  keyframes_ = keyframe.index + std::int64_t{1};
  publishing_.changed = true;
  saving_.changed = !folder_.empty();
}

// A whole answer without the word on how many there are: there may be more.
std::optional<std::int32_t> OctomapExportService::missing() const {
  if (!has_word_ && queue_.next_index() == asked_up_to_) return asked_up_to_;
  return queue_.missing();
}

void OctomapExportService::ask(std::int32_t first, std::int64_t now_us) {
  const bool is_answered = first == asked_up_to_;
  if (!is_answered && quiet_since_us_ && now_us - *quiet_since_us_ < kAskPeriod_us) return;
  quiet_since_us_ = now_us;
  request_us_ = now_us;
  has_word_ = false;
  asked_up_to_ = first + bus::kKeyframesAtOnce;
  map_request_t request{};
  request.utime = now_us;
  request.want = map_request_t::WANT_KEYFRAMES;
  request.first = first;
  bus_.publish(bus::kMapRequest, request);
}

void OctomapExportService::publish(std::int64_t now_us) {
  const Stopwatch stopwatch;
  map_octree_t message{};
  message.utime = utime_us_;
  message.map_id = map_id_;
  message.view_id = keyframes_;
  message.data = builder_.binary();
  message.num_bytes = static_cast<std::int32_t>(message.data.size());
  for (int i = 0; i < 4; ++i) message.transform[i][i] = 1.0F;
  bus_.publish(bus::kOctomap, message);
  publishing_ = {false, now_us, stopwatch.elapsed_us()};
}

void OctomapExportService::save(std::int64_t now_us) {
  const Stopwatch stopwatch;
  std::string error;
  try {
    write_files();
  } catch (const std::exception& e) {
    error = e.what();
    health_.count("failed_saves");
  }
  saving_ = {!error.empty(), now_us, stopwatch.elapsed_us()};
  save_error_ = error;
}

void OctomapExportService::write_files() const {
  std::filesystem::create_directories(folder_);
  builder_.write_bt(folder_ / "map.bt");
  builder_.write_ot(folder_ / "map.ot");
}

void OctomapExportService::report() {
  using State = bus::Health::State;
  const auto missing = queue_.missing();
  health_.raise("save", State::kError, save_error_);
  health_.raise("reach", State::kWarning, reach_sentence(builder_.reach_m()));
  if (!missing) return health_.clear("keyframes");
  if (*missing == 0)
    return health_.raise("keyframes", State::kOk, "waits for the map's first keyframe");
  health_.raise("keyframes", State::kWarning, fmt::format("waits for keyframe {}", *missing));
}

}  // namespace voxlist::services
