#include "services/octomap_export/octomap_export_service.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <utility>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/map_edits_t.hpp>
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

// Within this time (us) the mapper sends the keyframe that was handed out, if that was right.
constexpr std::int64_t kSuspicion_us = 2 * kSecond_us;

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
      cut_(planning::cut_of(config.octomap)),
      builder_(config.octomap),
      word_(health),
      edits_(health) {
  if (!folder_.empty()) io::remove_stale_temporaries(folder_);
  bus_.subscribe(bus::kKeyframe, [this](const keyframe_t& m) { take(m); });
  bus_.subscribe(bus::kMapEdits, [this](const map_edits_t& m) { edits_.take(m); });
  bus_.subscribe(bus::kMapUpdate, [this](const map_update_t& m) { take_word(m); });
}

void OctomapExportService::take_word(const map_update_t& message) {
  const auto before = word_.word();
  word_.take(message);
  // The keyframe follows what is told of it.
  if (before && word_.word()->version > before->version) quiet_since_us_ = now_us_;
  follow_word();
}

void OctomapExportService::follow_word() {
  const auto& word = word_.word();
  if (!word) return;
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  // Keyframes that were moved are all fetched anew.
  if (std::exchange(moves_, word->moves) != word->moves) queue_.start_over();
  queue_.know_of(word->map_id, static_cast<std::int32_t>(std::min(word->keyframes(), kMost)));
}

void OctomapExportService::take(const keyframe_t& message) {
  auto keyframe = bus::from_message(message);
  if (!keyframe) return health_.count("KEYFRAME/refused");
  if (!is_credible(*keyframe)) return;
  using Verdict = KeyframeQueue::Verdict;
  const Verdict verdict = queue_.add(std::move(*keyframe));
  if (verdict == Verdict::kRepeated) health_.count("KEYFRAME/repeated");
  if (verdict == Verdict::kDroppedOne) health_.count("KEYFRAME/queue_full");
}

// Whether the mapper has such a keyframe. Until it has said what it has, any will do: what is wrong
// with them shows then.
bool OctomapExportService::is_credible(const bus::PosedCloud& keyframe) {
  const auto& word = word_.word();
  if (!word) return true;
  const bool is_ours = keyframe.map_id == word->map_id;
  if (is_ours && keyframe.index < word->keyframes()) return !is_contradicted_by(keyframe);
  health_.count(is_ours ? "KEYFRAME/beyond_the_map" : "KEYFRAME/other_map");
  word_.doubt();
  return false;
}

bool OctomapExportService::is_contradicted_by(const bus::PosedCloud& keyframe) {
  const bool differs = queue_.is_contradicted_by(keyframe);
  const bool is_suspect = suspicion_ && suspicion_->index == keyframe.index;
  if (differs) {
    health_.count("KEYFRAME/contradicts");
    if (!suspicion_) suspicion_ = Suspicion{keyframe.index, now_us_};
    if (is_suspect) suspicion_->is_repeated = true;
  } else if (is_suspect) {
    suspicion_.reset();
  }
  return differs;
}

void OctomapExportService::settle_suspicion(std::int64_t now_us) {
  if (!suspicion_) return;
  if (!std::exchange(suspicion_->is_asked, true))
    return request(map_request_t::WANT_KEYFRAMES, suspicion_->index, now_us);
  if (now_us - suspicion_->since_us < kSuspicion_us) return;
  if (suspicion_->is_repeated) queue_.start_over();
  suspicion_.reset();
}

void OctomapExportService::tick(std::int64_t now_us) {
  now_us_ = now_us;
  word_.tick(now_us);
  settle_suspicion(now_us);
  follow_word();
  if (const auto question_us = word_.due(now_us))
    request(map_request_t::WANT_WORD, 0, *question_us);
  if (const auto keyframe = queue_.next()) {
    insert(*keyframe);
    quiet_since_us_ = now_us;
  }
  if (const auto first = missing()) ask(*first, now_us);
  follow_edits(now_us);
  if (service::stop_requested()) return;
  if (has_edits() && publishing_.due(now_us, kPublishPeriod_us)) publish(now_us);
  // While it catches up, a file of an earlier run holds more than it does: the first period starts
  // with the service, and none ends before everything is in.
  if (!saving_.last_us) saving_.last_us = now_us;
  const auto save_period_us = static_cast<std::int64_t>(config_.save_period_s * kSecond_us);
  const bool is_whole = queue_.is_done() && has_edits();
  if (save_period_us > 0 && is_whole && saving_.due(now_us, save_period_us)) save(now_us);
  report();
}

void OctomapExportService::stop() {
  if (!saving_.changed || !has_edits()) return;
  save(0);
  if (!save_error_.empty()) throw std::runtime_error("the last save failed: " + save_error_);
}

void OctomapExportService::insert(const bus::PosedCloud& keyframe) {
  if (keyframe.index == 0) {
    builder_ = planning::OctomapBuilder(config_.octomap);
    edits_.start_over();
  }
  builder_.insert(keyframe.T_map_base, keyframe.cloud, service::stop_requested);
  map_id_ = keyframe.map_id;
  utime_us_ = keyframe.cloud.utime_us;
  keyframes_ = keyframe.index + std::int64_t{1};
  note_change();
}

void OctomapExportService::note_change() {
  publishing_.changed = true;
  saving_.changed = !folder_.empty();
}

void OctomapExportService::follow_edits(std::int64_t now_us) {
  if (!word_.word()) return;
  if (edits_.is_due(*word_.word(), now_us)) request(map_request_t::WANT_EDITS, 0, now_us);
  const auto boxes = edits_.news(*word_.word());
  if (!boxes) return;
  builder_.edit(*boxes);
  note_change();
}

// What was erased by hand is not told as if it were there.
bool OctomapExportService::has_edits() const {
  return !word_.word() || edits_.follows(*word_.word());
}

// A whole answer without the word on how many there are: there may be more.
std::optional<std::int32_t> OctomapExportService::missing() const {
  if (!word_.word() && queue_.next_index() == asked_up_to_) return asked_up_to_;
  return queue_.missing();
}

void OctomapExportService::ask(std::int32_t first, std::int64_t now_us) {
  const bool is_answered = first == asked_up_to_;
  if (!is_answered && quiet_since_us_ && now_us - *quiet_since_us_ < kAskPeriod_us) return;
  quiet_since_us_ = now_us;
  asked_up_to_ = first + bus::kKeyframesAtOnce;
  request(map_request_t::WANT_KEYFRAMES, first, now_us);
}

void OctomapExportService::request(std::int32_t want, std::int32_t first, std::int64_t utime_us) {
  map_request_t message{};
  message.utime = utime_us;
  message.want = want;
  message.first = first;
  bus_.publish(bus::kMapRequest, message);
}

// What is known already is not told again: a keyframe that changes nothing, or nothing in the box.
void OctomapExportService::publish(std::int64_t now_us) {
  const Stopwatch stopwatch;
  std::vector<std::uint8_t> bytes = builder_.binary(cut_);
  if (bytes != published_ || map_id_ != published_map_id_) send(bytes);
  published_ = std::move(bytes);
  published_map_id_ = map_id_;
  publishing_ = {false, now_us, stopwatch.elapsed_us()};
}

void OctomapExportService::send(const std::vector<std::uint8_t>& bytes) {
  map_octree_t message{};
  message.utime = utime_us_;
  message.map_id = map_id_;
  message.view_id = keyframes_;
  message.data = bytes;
  message.num_bytes = static_cast<std::int32_t>(message.data.size());
  for (int i = 0; i < 4; ++i) message.transform[i][i] = 1.0F;
  bus_.publish(bus::kOctomap, message);
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
  builder_.write_bt(folder_ / "map.bt", cut_);
  builder_.write_ot(folder_ / "map.ot", cut_);
}

void OctomapExportService::report() {
  using State = bus::Health::State;
  const auto missing = queue_.missing();
  health_.gauge("keyframes_waiting", static_cast<double>(queue_.waiting()));
  health_.raise("save", State::kError, save_error_);
  health_.raise("reach", State::kWarning, reach_sentence(builder_.reach_m()));
  health_.raise("edits", State::kWarning, has_edits() ? "" : "waits for the map's edits by hand");
  if (!missing) return health_.clear("keyframes");
  if (*missing == 0)
    return health_.raise("keyframes", State::kOk, "waits for the map's first keyframe");
  health_.raise("keyframes", State::kWarning, fmt::format("waits for keyframe {}", *missing));
}

}  // namespace voxlist::services
