#include "services/mapper/apart/apart_session.h"

#include <fmt/core.h>

#include <utility>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/bus/convert.h"
#include "voxlist/bus/event_log.h"
#include "voxlist/bus/health.h"
#include "voxlist/geometry/angle.h"
#include "voxlist/io/files/keep_aside.h"

namespace voxlist::services {
namespace {

// Most bytes that are kept: of a robot that is not found for long, the rest is a drive of its own.
constexpr std::size_t kMostBytes = 256'000'000;
// A cloud is kept after such a way or turn (m, rad): what is tracked then.
constexpr double kMoved_m = 0.3, kTurned_rad = 12.0 * kRadPerDeg;
// After so many clouds in a row that fit nowhere, those before them are left alone: the robot was
// carried, or the clouds show nothing.
constexpr int kMostMisses = 5;

std::size_t bytes_of(const Cloud& cloud) {
  return (cloud.points.size() + cloud.origins.size()) * sizeof(Eigen::Vector3f);
}

}  // namespace

ApartSession::ApartSession(bus::Health& health, const std::filesystem::path& folder, TiltUse tilt)
    : health_(health), folder_(folder), tilt_(tilt) {
  if (folder_.empty()) return;
  if (keep_recording_of_before()) state_ = State::kWaiting;
}

ApartSession::~ApartSession() = default;

bool ApartSession::keep_recording_of_before() const {
  const std::filesystem::path file = folder_ / kApartFile;
  std::error_code error;
  if (exists(file)) rename(file, io::free_name(file, ""), error);
  return !error;
}

void ApartSession::add(Cloud cloud, const std::optional<Pose2>& T_odom_base) {
  if (!is_waiting() || !has_moved(T_odom_base)) return;
  bytes_ += bytes_of(cloud);
  if (bytes_ > kMostBytes) return health_.count("apart/no_room");
  kept_.push_back({std::move(cloud), T_odom_base});
  record(kept_.back());
  tell();
}

bool ApartSession::has_moved(const std::optional<Pose2>& T_odom_base) const {
  if (kept_.empty() || !T_odom_base || !kept_.back().T_odom_base) return true;
  const Pose2& last = *kept_.back().T_odom_base;
  return distance_m(last, *T_odom_base) >= kMoved_m || turn_rad(last, *T_odom_base) >= kTurned_rad;
}

// What the disk does not take is in memory all the same.
void ApartSession::record(const Kept& kept) try {
  if (!recording_)
    recording_ = std::make_unique<bus::EventLogWriter>((folder_ / kApartFile).string());
  const std::int64_t utime_us = kept.cloud.utime_us;
  if (kept.T_odom_base)
    recording_->write(bus::kOdometry, utime_us,
                      bus::to_message(StampedPose2{utime_us, *kept.T_odom_base}));
  recording_->write(bus::kCloud, utime_us,
                    bus::to_message(kept.cloud, "base", static_cast<std::int32_t>(kept_.size())));
} catch (const std::exception&) {
  health_.count("apart/not_recorded");
}

void ApartSession::found(std::int64_t utime_us, const std::optional<Pose2>& T_odom_base,
                         const UncertainPose& pose, const OccupancyMap& map) {
  if (!is_waiting()) return;
  if (kept_.empty()) return end();
  state_ = State::kJoining;
  matching::LocaliserConfig config;
  config.tilt = tilt_;
  config.threads = 1;
  localiser_ = std::make_unique<matching::Localiser>(map, config);
  localiser_->start_at(utime_us, T_odom_base, pose);
  found_us_ = utime_us;
}

std::optional<ApartSession::Placed> ApartSession::place_next() {
  if (state_ != State::kJoining) return std::nullopt;
  if (kept_.empty() || misses_ == kMostMisses) {
    end();
    return std::nullopt;
  }
  Kept kept = std::move(kept_.back());
  kept_.pop_back();
  const std::int64_t utime_us =
      std::exchange(kept.cloud.utime_us, 2 * found_us_ - kept.cloud.utime_us);
  const matching::Localisation located = localiser_->localise(kept.cloud, kept.T_odom_base);
  kept.cloud.utime_us = utime_us;
  misses_ = located.tracking() ? 0 : misses_ + 1;
  health_.count(located.tracking() ? "apart/joined" : "apart/without_place");
  if (!located.tracking()) {
    ++without_place_;
    return std::nullopt;
  }
  const matching::PoseMode& mode = located.modes.front();
  return Placed{std::move(kept.cloud), mode.T_map_base, mode.tilt, kept.T_odom_base};
}

void ApartSession::map_changed(const ChangedBlocks& changed) {
  if (localiser_) localiser_->map_changed(changed);
}

// The recording stays where not all of it is in the map.
void ApartSession::end() {
  if (state_ == State::kDone) return;
  state_ = State::kDone;
  without_place_ += std::ssize(kept_);
  kept_.clear();
  localiser_.reset();
  recording_.reset();
  std::error_code ignored;
  if (without_place_ == 0) std::filesystem::remove(folder_ / kApartFile, ignored);
  tell();
}

void ApartSession::tell() const {
  using HealthState = bus::Health::State;
  const std::string file = (folder_ / kApartFile).string();
  std::string sentence;
  if (is_waiting())
    sentence = fmt::format("the robot was not found in the map yet: {} clouds are kept in {}",
                           kept_.size(), file);
  else if (without_place_ > 0)
    sentence = fmt::format(
        "{} clouds from before the robot was found have no place in the map: voxlist map {} --into "
        "it may find one",
        without_place_, file);
  health_.raise("apart", is_waiting() ? HealthState::kWarning : HealthState::kOk, sentence);
}

}  // namespace voxlist::services
