#include "services/cloud_assembler/cloud_assembler_service.h"

#include <fmt/core.h>

#include <utility>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"

namespace voxlist::services {
namespace {

// An input is silent after this (us): 75 lines, or 20 poses at ODOMETRY's lowest rate. Shorter, and
// a busy machine's pauses are told as silence; longer, and a person waits for the reason.
constexpr std::int64_t kSilence_us = 1'000'000;

// Below this share of a sweep's lines HEALTH warns. It leaves three of 75 lines: one or two that
// are lost in a sweep are everyday life on a serial line.
constexpr double kGoodLineShare = 0.95;

}  // namespace

CloudAssemblerService::CloudAssemblerService(bus::Bus& bus, bus::Health& health,
                                             const scanner::CloudAssemblerConfig& config)
    : bus_(bus), health_(health), config_(config), assembler_(config) {
  for (const auto& [input, channel] :
       {std::pair{&laser_, bus::kLaser.name}, std::pair{&mirror_, bus::kMirror.name},
        std::pair{&odometry_, bus::kOdometry.name}}) {
    input->times.emplace(
        health, service::ChannelCheck::Options{
                    .channel = channel, .remedy = "", .disorder_us = OdometryBuffer::kMaxAge_us});
  }
  bus_.subscribe(bus::kLaser, [this](const planar_lidar_t& m) { take_laser(m); });
  bus_.subscribe(bus::kMirror, [this](const mirror_state_t& m) { take_mirror(m); });
  bus_.subscribe(bus::kOdometry, [this](const pose_t& m) { take_odometry(m); });
}

void CloudAssemblerService::check(const scanner::CloudAssemblerConfig& config) {
  scanner::CloudAssembler{config};
}

bool CloudAssemblerService::fits(Input& input, std::int64_t utime_us) {
  input.heard = true;
  return input.times->take(utime_us);
}

void CloudAssemblerService::take_laser(const planar_lidar_t& message) {
  if (!fits(laser_, message.utime)) return;
  auto line = bus::from_message(message);
  if (!line) return health_.count("LASER/not_a_line");
  publish(assembler_.add_line(std::move(*line)));
}

void CloudAssemblerService::take_mirror(const mirror_state_t& message) {
  if (!fits(mirror_, message.utime)) return;
  auto state = bus::from_message(message);
  if (!state) return health_.count("MIRROR/not_a_state");
  mirror_state_ = std::move(*state);
  publish(assembler_.add_mirror(mirror_state_));
}

void CloudAssemblerService::take_odometry(const pose_t& message) {
  if (!fits(odometry_, message.utime)) return;
  const auto pose = bus::from_message(message);
  if (!pose) return health_.count("ODOMETRY/not_a_pose");
  publish(assembler_.add_odometry({pose->utime_us, to_pose2(pose->pose)}));
}

void CloudAssemblerService::publish(const scanner::Assembly& assembly) {
  for (const Cloud& slice : assembly.slices)
    bus_.publish(bus::kCloudSlice, bus::to_message(slice, "base", slices_++));
  for (const Cloud& cloud : assembly.clouds) {
    bus_.publish(bus::kCloud, bus::to_message(cloud, "base", clouds_++));
    arrival_us_ = bus_.arrival_utime_us();
  }
  line_share_ = assembly.line_share.value_or(line_share_);
  for (const auto& [what, times] : by_counter_name(assembly.counts)) health_.count(what, times);
  if (has_used_line(assembly.counts)) used_.heard = true;
  if (const auto fate = unused_line(assembly.counts); fate && !used_.heard) last_drop_ = fate;
}

void CloudAssemblerService::tick(std::int64_t now_us) {
  for (Input* input : {&laser_, &mirror_, &odometry_, &used_}) {
    if (!started_) input->last_us = now_us;
    input->note(now_us);
  }
  for (Input* input : {&laser_, &mirror_, &odometry_}) input->times->tick(now_us);
  started_ = true;
  if (arrival_us_) health_.add_latency_us(now_us - *arrival_us_);
  arrival_us_.reset();
  tell_state(now_us);
}

void CloudAssemblerService::tell_state(std::int64_t now_us) {
  using State = bus::Health::State;
  const std::string why_none = why_no_clouds(now_us);
  const bool goes_on = why_none.empty();
  const bool is_doubtful = goes_on && mirror_state_.state == MirrorState::State::kFault;
  health_.raise("clouds", State::kError, why_none);
  health_.raise("mirror", State::kWarning, is_doubtful ? "mirror: " + mirror_state_.reason : "");
  health_.raise("lines", State::kWarning,
                !goes_on || line_share_ >= kGoodLineShare
                    ? ""
                    : fmt::format("the last sweep had only {:.0f} % of its lines: see "
                                  "LASER/missing and the other counters",
                                  100.0 * line_share_));
}

// The first cause alone: what comes after it follows from it.
std::string CloudAssemblerService::why_no_clouds(std::int64_t now_us) const {
  if (laser_.is_silent(now_us)) return "no LASER: is laser_driver running?";
  if (mirror_.is_silent(now_us)) return "no MIRROR: is mirror_monitor running?";
  if (!mirror_state_.angle_known) return "mirror's angle not known: " + mirror_state_.reason;
  if (config_.use_odometry && odometry_.is_silent(now_us))
    return "no ODOMETRY, so no clouds: is the robot base running? Without one set use_odometry = "
           "false";
  if (used_.is_silent(now_us))
    return fmt::format("no line can be used{}: do the times of LASER, MIRROR and ODOMETRY agree?",
                       drop_reason());
  return {};
}

std::string CloudAssemblerService::drop_reason() const {
  return last_drop_ ? " (" + scanner::counter_name(*last_drop_) + ")" : "";
}

void CloudAssemblerService::Input::note(std::int64_t now_us) {
  if (heard) last_us = now_us;
  heard = false;
}

bool CloudAssemblerService::Input::is_silent(std::int64_t now_us) const {
  return now_us - last_us > kSilence_us;
}

}  // namespace voxlist::services
