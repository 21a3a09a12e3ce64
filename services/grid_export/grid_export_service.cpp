#include "services/grid_export/grid_export_service.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <stdexcept>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/maps/map_convert.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/planning/grids/grid_files.h"
#include "voxlist/system/state_folder.h"

namespace voxlist::services {
namespace {

constexpr std::int64_t kSecond_us = 1'000'000;

// Grids are made this often at most, and for no more than a third of the time; where the way alone
// has grown, which seldom changes one, once a second.
constexpr std::int64_t kPeriod_us = 100'000;
constexpr std::int64_t kShare = 3;

void append(const std::vector<Voxel>& more, std::vector<Voxel>& blocks) {
  blocks.insert(blocks.end(), more.begin(), more.end());
}

std::int64_t microseconds(double s) { return static_cast<std::int64_t>(s * kSecond_us); }

std::filesystem::path folder_of(const GridExportConfig& config) {
  return in_state_folder(config.folder);
}

}  // namespace

GridExportService::GridExportService(bus::Bus& bus, bus::Health& health,
                                     const GridExportConfig& config)
    : bus_(bus),
      health_(health),
      config_(config),
      folder_(folder_of(config)),
      occupied_{service::MapFollower(health), {}, {}},
      free_{service::MapFollower(health, service::kFreeSpaceSource), {}, {}},
      builder_(config.robots.in_use()),
      scans_(bus, health, builder_.robots()),
      grids_(bus, builder_.robots(), microseconds(config.repeat_period_s)) {
  check(config);
  if (!folder_.empty()) io::remove_stale_temporaries(folder_);
  bus_.subscribe(bus::kMapUpdate, [this](const map_update_t& m) { take(m, occupied_); });
  bus_.subscribe(bus::kFreeSpace, [this](const map_update_t& m) { take(m, free_); });
  bus_.subscribe(bus::kKeyframe, [this](const keyframe_t& m) { way_has_grown_ |= way_.take(m); });
  bus_.subscribe(bus::kPose, [this](const pose_t& m) { way_.take(m); });
  bus_.subscribe(bus::kPoseCovariance,
                 [this](const uncertain_pose_t& m) { way_has_grown_ |= way_.take(m); });
}

void GridExportService::check(const GridExportConfig& config) {
  if (const std::string wrong = planning::why_invalid(config.robots); !wrong.empty())
    throw std::invalid_argument(wrong);
}

void GridExportService::take(const map_update_t& message, Input& input) {
  for (const bus::MapChange& change : input.follower.take(message)) {
    const bus::AppliedChange applied = bus::apply(change, input.map);
    input.is_replaced |= applied.replaced;
    append(applied.changed.occupied, input.changed.occupied);
    append(applied.changed.passed, input.changed.passed);
    moves_ = change.moves;
    edits_ = change.edits;
  }
  follow_mapper();
}

// Whether or not a map has come: what was made of another one is not shown any longer than that.
void GridExportService::follow_mapper() {
  if (occupied_.follower.map_id() != map_id_) {
    map_id_ = occupied_.follower.map_id();
    grids_.forget();
    for (Input* input : {&occupied_, &free_})
      if (!input->follower.held()) {
        input->map = {};
        input->is_replaced = true;
      }
  }
  const auto& held = occupied_.follower.held();
  if (held) way_.follow({held->map_id, moves_, held->version - moves_ - edits_});
}

void GridExportService::ask(Input& input, std::int64_t now_us) {
  if (const auto request = input.follower.tick(now_us)) bus_.publish(bus::kMapRequest, *request);
}

void GridExportService::tick(std::int64_t now_us) {
  scans_.tick(now_us);
  ask(occupied_, now_us);
  ask(free_, now_us);
  follow_mapper();
  if (const auto first = way_.due(now_us)) {
    map_request_t request{};
    request.utime = now_us;
    request.want = map_request_t::WANT_KEYFRAMES;
    request.first = *first;
    bus_.publish(bus::kMapRequest, request);
  }
  if (is_due(now_us)) make(now_us);
  grids_.tick(now_us);
  const std::int64_t save_period_us = microseconds(config_.save_period_s);
  if (!is_saved_ && (!saved_us_ || now_us - *saved_us_ >= save_period_us)) save(now_us);
  report();
}

void GridExportService::stop() {
  if (is_saved_) return;
  save(0);
  if (!save_error_.empty()) throw std::runtime_error("the last save failed: " + save_error_);
}

// Both halves are of one version of one map.
bool GridExportService::is_whole() const {
  const auto &map = occupied_.follower.held(), &free = free_.follower.held();
  return map && free && map->map_id == free->map_id && map->version == free->version;
}

bool GridExportService::is_due(std::int64_t now_us) const {
  if (!is_whole()) return false;
  const auto is_over = [&](const std::optional<std::int64_t>& since_us, std::int64_t period_us) {
    return !since_us || now_us - *since_us >= std::max(period_us, kShare * took_us_);
  };
  if (!is_made()) return is_over(followed_us_, kPeriod_us);
  return way_has_grown_ && is_over(made_us_, kSecond_us);
}

// The grids that were sent last are of the map as it is.
bool GridExportService::is_made() const {
  const auto& held = *occupied_.follower.held();
  return held.map_id == source_.map_id && held.version == source_.version;
}

void GridExportService::bring_up_to_date() {
  if (occupied_.is_replaced || free_.is_replaced)
    builder_.take(occupied_.map, free_.map);
  else
    builder_.follow(occupied_.map, occupied_.changed, free_.map, free_.changed);
  for (Input* input : {&occupied_, &free_}) {
    input->changed = {};
    input->is_replaced = false;
  }
  if (std::exchange(way_has_grown_, false)) builder_.drive(way_.keyframes(), way_.poses());
}

void GridExportService::make(std::int64_t now_us) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  bring_up_to_date();
  const bool is_newer = !is_made();
  const auto& held = *occupied_.follower.held();
  source_ = {held.utime_us, held.map_id, held.version};
  const bool has_changed = builder_.update().has_value();
  if (has_changed) is_saved_ = folder_.empty();
  if (has_changed || is_newer) grids_.send(builder_.grids(), source_, now_us);
  made_us_ = now_us;
  if (is_newer) followed_us_ = now_us;
  took_us_ = std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start).count();
  health_.add_latency_us(took_us_);
}

void GridExportService::save(std::int64_t now_us) {
  save_error_.clear();
  try {
    std::filesystem::create_directories(folder_);
    const auto& grids = builder_.grids();
    for (std::size_t i = 0; i < grids.size(); ++i)
      planning::write_grid(grids[i], folder_, builder_.robots()[i].name);
  } catch (const std::exception& e) {
    save_error_ = e.what();
    health_.count("failed_saves");
  }
  saved_us_ = now_us;
  is_saved_ = save_error_.empty();
}

void GridExportService::report() {
  using State = bus::Health::State;
  health_.gauge("cells", static_cast<double>(builder_.cells()));
  health_.gauge("made_in_ms", static_cast<double>(took_us_) * 1e-3);
  health_.raise("save", State::kError, save_error_);
  health_.raise("cells", State::kError,
                builder_.cells() <= planning::kMostCells
                    ? ""
                    : fmt::format("the map spans {} cells, more than a grid has: no grid is sent",
                                  builder_.cells()));
  health_.raise("map", State::kOk, is_whole() ? "" : "waits for the mapper's map and free space");
}

}  // namespace voxlist::services
