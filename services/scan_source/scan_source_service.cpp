#include "services/scan_source/scan_source_service.h"

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <stdexcept>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/io/files/file.h"

namespace voxlist::services {
namespace {

// Time from the last scan of a round to the first of the next when there is only one scan, which
// has no period of its own.
constexpr std::int64_t kDefaultPeriod_us = 1'000'000;

const ScanSourceConfig& checked(const ScanSourceConfig& config) {
  if (config.folder.empty())
    throw std::invalid_argument("no scans: set folder in the table [scan_source] of --config FILE");
  return config;
}

}  // namespace

ScanSourceService::ScanSourceService(bus::Bus& bus, bus::Health& health,
                                     const ScanSourceConfig& config)
    : bus_(bus),
      health_(health),
      config_(checked(config)),
      folder_(config.folder),
      events_(io::events_of(folder_)) {
  for (const std::string& note : folder_.file_notes()) spdlog::warn("scans: {}", note);
  for (const std::string& note : folder_.notes()) spdlog::warn("poses: {}", note);
}

void ScanSourceService::check(const ScanSourceConfig& config) { checked(config); }

std::int64_t ScanSourceService::round_us() const {
  const auto scans = static_cast<std::int64_t>(folder_.size());
  const std::int64_t scans_us = folder_.utime_us(folder_.size() - 1) - folder_.utime_us(0);
  const std::int64_t period_us = scans > 1 ? scans_us / (scans - 1) : kDefaultPeriod_us;
  return events_.back().utime_us - events_.front().utime_us + period_us;
}

void ScanSourceService::tick(std::int64_t now_us) {
  if (!start_us_) start_us_ = now_us;
  for (bool scan_told = false; !scan_told && is_due(now_us); advance()) {
    const io::FolderEvent& event = events_[next_];
    if (event.is_scan) publish_scan(event.number);
    if (!event.is_scan) publish_odometry(event.number);
    scan_told = event.is_scan;
  }
}

bool ScanSourceService::is_due(std::int64_t now_us) const {
  if (next_ == events_.size()) return false;
  const std::int64_t data_us = events_[next_].utime_us + later_us_ - events_.front().utime_us;
  return static_cast<double>(data_us) <= config_.speed * static_cast<double>(now_us - *start_us_);
}

void ScanSourceService::advance() {
  if (++next_ < events_.size()) return;
  say_how_it_went();
  if (!config_.loop) return;
  next_ = 0;
  later_us_ += round_us();
}

void ScanSourceService::publish_odometry(std::size_t row) {
  const io::PoseRow& odometry = folder_.odometry()->rows[row];
  bus_.publish(bus::kOdometry,
               bus::to_message(StampedPose3{odometry.utime_us + later_us_, odometry.pose}));
}

void ScanSourceService::publish_scan(std::size_t scan) try {
  Cloud cloud = folder_.read(scan);
  cloud.utime_us += later_us_;
  if (const auto truth = folder_.truth(scan))
    bus_.publish(bus::kTruth, bus::to_message(StampedPose3{cloud.utime_us, *truth}));
  bus_.publish(bus::kCloud, bus::to_message(cloud, "base", clouds_++));
} catch (const io::FileError& error) {
  ++unreadable_;
  health_.count("unreadable_scans");
  spdlog::warn("{}", error.what());
}

void ScanSourceService::say_how_it_went() {
  using State = bus::Health::State;
  health_.raise("end", State::kOk, config_.loop ? "" : "all scans are out");
  health_.raise("unreadable", State::kWarning,
                unreadable_ > 0 ? fmt::format("{} scan(s) could not be read", unreadable_) : "");
}

}  // namespace voxlist::services
