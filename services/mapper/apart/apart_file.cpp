#include "services/mapper/apart/apart_file.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <system_error>
#include <utility>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/bus/convert.h"
#include "voxlist/bus/event_log.h"
#include "voxlist/bus/health.h"
#include "voxlist/io/files/keep_aside.h"

namespace voxlist::services {
namespace {

// Names that are told.
constexpr std::size_t kMostNames = 3;

std::vector<std::string> numbered_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (std::string name = entry.path().filename(); name.starts_with(std::string(kApartFile) + "-"))
      names.push_back(std::move(name));
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

ApartFile::ApartFile(bus::Health& health, const std::filesystem::path& folder)
    : health_(health), folder_(folder) {
  if (is_possible()) left_ = numbered_in(folder_);
  tell();
}

ApartFile::~ApartFile() = default;

void ApartFile::write(const ApartCloud& kept) try {
  if (!log_) log_ = std::make_unique<bus::EventLogWriter>(path().string());
  const std::int64_t utime_us = kept.cloud.utime_us;
  if (kept.T_odom_base)
    log_->write(bus::kOdometry, utime_us,
                bus::to_message(StampedPose2{utime_us, *kept.T_odom_base}));
  log_->write(bus::kCloud, utime_us, bus::to_message(kept.cloud, "base", 0));
  log_->flush();
} catch (const std::exception&) {
  health_.count("apart/not_recorded");
}

void ApartFile::remove() {
  log_.reset();
  std::error_code ignored;
  std::filesystem::remove(path(), ignored);
}

void ApartFile::leave() try {
  log_.reset();
  if (!exists(path())) return;
  const std::filesystem::path numbered = io::free_name(path(), "");
  rename(path(), numbered);
  left_.push_back(numbered.filename());
  tell();
} catch (const std::exception&) {
  health_.count("apart/not_recorded");
}

std::optional<std::filesystem::path> ApartFile::left_by_another() {
  const std::size_t before = left_.size();
  if (is_possible()) leave();
  return left_.size() > before ? std::optional(folder_ / left_.back()) : std::nullopt;
}

void ApartFile::remove_left(const std::filesystem::path& file) {
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  std::erase(left_, file.filename());
  tell();
}

void ApartFile::tell() const {
  if (left_.empty()) return health_.clear("apart_left");
  const auto told = std::min(left_.size(), kMostNames);
  health_.raise(
      "apart_left", bus::Health::State::kOk,
      fmt::format("{} recordings of drives have no place in the map ({}{}): voxlist extend {} FILE "
                  "may find one",
                  left_.size(),
                  fmt::join(left_.begin(), left_.begin() + std::ptrdiff_t(told), ", "),
                  told < left_.size() ? ", ..." : "", folder_.string()));
}

std::vector<ApartCloud> read_apart_file(const std::filesystem::path& file) {
  std::vector<ApartCloud> clouds;
  bus::EventLogReader log(file.string());
  std::optional<StampedPose3> T_odom_base;
  while (const auto event = log.next()) {
    pose_t pose;
    if (event->channel == bus::kOdometry.name &&
        bus::decode(event->bytes, pose) == bus::Fault::kNone)
      T_odom_base = bus::from_message(pose);
    pointcloud_t message;
    if (event->channel != bus::kCloud.name ||
        bus::decode(event->bytes, message) != bus::Fault::kNone)
      continue;
    auto received = bus::from_message(message);
    if (!received.cloud) continue;
    ApartCloud cloud{std::move(*received.cloud), Pose3::Identity(), std::nullopt};
    if (T_odom_base && T_odom_base->utime_us == cloud.cloud.utime_us)
      cloud.T_odom_base = to_pose2(T_odom_base->pose);
    clouds.push_back(std::move(cloud));
  }
  return clouds;
}

}  // namespace voxlist::services
