#include "services/voxlist/recording/simulated_log.h"

#include <limits>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/bus/convert.h"
#include "voxlist/geometry/angle.h"

namespace voxlist::desk {
namespace {

// Time from a line's first beam until a driver has it (us): half a turn of the laser's mirror, and
// 732 bytes at 500 kbaud.
constexpr std::int64_t kTravel_us = 6'667 + 14'640;

scanner::MirrorClockConfig clock_of(const simulation::MirrorScannerConfig& scanner) {
  scanner::MirrorClockConfig clock;
  for (const simulation::ArmRod& arm : scanner.mirror.arms)
    clock.arms.push_back({arm.angle_deg * kRadPerDeg, arm.beam_first_deg * kRadPerDeg,
                          arm.beam_last_deg * kRadPerDeg});
  clock.steps_per_revolution = scanner.motor.steps_per_turn;
  clock.staircase = scanner.motor.staircase;
  return clock;
}

StampedPose2 dated(StampedPose2 pose) {
  pose.utime_us += SimulatedLog::kStart_us;
  return pose;
}

}  // namespace

SimulatedLog::SimulatedLog(const std::string& path, const std::string& prefix,
                           const simulation::MirrorScannerConfig& scanner,
                           const scanner::CloudAssemblerConfig& assembler, Deskew deskew)
    : log_(path, prefix), mirror_(clock_of(scanner)), assembler_(assembler), deskew_(deskew) {}

void SimulatedLog::operator()(const simulation::SimulatedOdometry& event) {
  const StampedPose2 pose = dated(event.measured);
  hear_lines(pose.utime_us);
  log_.write(bus::kOdometry, pose.utime_us, bus::to_message(pose));
  ++counts_.odometry;
  if (deskew_ == Deskew::kWheels) write(assembler_.add_odometry(pose), pose.utime_us);
}

void SimulatedLog::operator()(const simulation::SimulatedTruth& event) {
  const StampedPose2 pose = dated(event.pose);
  hear_lines(pose.utime_us);
  log_.write(bus::kTruth, pose.utime_us, bus::to_message(pose));
  if (deskew_ == Deskew::kTruth) write(assembler_.add_odometry(pose), pose.utime_us);
}

void SimulatedLog::operator()(const simulation::SimulatedClockEdge& event) {
  const std::int64_t utime_us = event.utime_us + kStart_us;
  hear_lines(utime_us);
  mirror_.add_edge(utime_us);
}

void SimulatedLog::operator()(const LaserLine& line) {
  hear_lines(line.utime_us + kStart_us);
  under_way_.push_back(line);
  under_way_.back().utime_us += kStart_us;
}

void SimulatedLog::operator()(const Cloud&) {}

void SimulatedLog::close() {
  hear_lines(std::numeric_limits<std::int64_t>::max());
  log_.close();
}

void SimulatedLog::hear_lines(std::int64_t until_us) {
  while (!under_way_.empty() && under_way_.front().utime_us + kTravel_us <= until_us) {
    hear(under_way_.front(), under_way_.front().utime_us + kTravel_us);
    under_way_.pop_front();
  }
}

void SimulatedLog::hear(const LaserLine& line, std::int64_t heard_us) {
  log_.write(bus::kLaser, heard_us, bus::to_message(line));
  ++counts_.lines;
  const MirrorState state = mirror_.add_line(line);
  log_.write(bus::kMirror, heard_us, bus::to_message(state));
  write(assembler_.add_mirror(state), heard_us);
  write(assembler_.add_line(line), heard_us);
}

void SimulatedLog::write(const scanner::Assembly& assembly, std::int64_t heard_us) {
  for (const Cloud& slice : assembly.slices)
    log_.write(bus::kCloudSlice, heard_us,
               bus::to_message(slice, "base", static_cast<std::int32_t>(counts_.slices++)));
  for (const Cloud& cloud : assembly.clouds)
    log_.write(bus::kCloud, heard_us,
               bus::to_message(cloud, "base", static_cast<std::int32_t>(counts_.clouds++)));
}

}  // namespace voxlist::desk
