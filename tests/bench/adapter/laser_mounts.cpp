// `voxlist calibrate --laser` on drives with simulated mounts: what it found, and by how much that
// is off. Usage: laser_mounts [SECONDS (90)] [MOUNTS (10)] [SEED (1)]
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "services/voxlist/maps/laser_calibration.h"
#include "tests/bench/adapter/mounted_drive.h"
#include "tests/temporary_folder.h"
#include "voxlist/geometry/angle.h"
#include "voxlist/simulation/random.h"

namespace {

using namespace voxlist;
using namespace voxlist::bench;
using desk::kLaserParameters;

Mounted any_mount(std::uint64_t seed) {
  simulation::Random random(seed);
  return {.roll_deg = random.uniform(-15.0, 15.0),
          .pitch_deg = random.uniform(-15.0, 15.0),
          .yaw_deg = random.uniform(-180.0, 180.0),
          .x_m = random.uniform(-0.5, 0.5),
          .y_m = random.uniform(-0.3, 0.3),
          .z_m = random.uniform(0.4, 1.6),
          .latency_ms = random.uniform(-30.0, 30.0)};
}

// In the order of kLaserParameters.
std::array<double, 7> truth_of(const Mounted& m) {
  return {m.roll_deg, m.pitch_deg, m.z_m, m.yaw_deg, m.x_m, m.y_m, m.latency_ms};
}

double error(std::size_t i, double found, double truth) {
  const bool is_yaw = i == 3;
  return is_yaw ? wrap_angle((found - truth) * kRadPerDeg) / kRadPerDeg : found - truth;
}

desk::LaserCalibration calibrated(const Mounted& mount, double seconds, std::uint64_t seed) {
  const test::TemporaryFolder work;
  const std::string log = work / "drive.lcm";
  write_drive(log, mount, seconds, seed);
  adapter::AdapterConfig config;
  config.sensors.emplace_back().channel = "LASER_3D";
  config.sensors[0].time_channel = "time";
  desk::Console console(std::cout, std::cerr, false);
  return desk::calibrate_laser(log, "", config, {}, console);
}

void print(std::uint64_t seed, const desk::LaserCalibration& found, const Mounted& mount) {
  const auto truth = truth_of(mount);
  fmt::print("| {} |", seed);
  for (std::size_t i = 0; i < kLaserParameters.size(); ++i) {
    const double off = error(i, found.after.*kLaserParameters[i].value, truth[i]);
    if (found.sd[i])
      fmt::print(" {:.3f} ({:.3f}) |", off, *found.sd[i]);
    else
      fmt::print(" held |");
  }
  fmt::print(" {} of {} |\n", found.placed, found.scans);
  for (const std::string& refusal : found.refusals) fmt::print("  {}\n", refusal);
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 90.0;
  const int mounts = argc > 2 ? std::atoi(argv[2]) : 10;
  const std::uint64_t first = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1;
  fmt::print("| seed |");
  for (const desk::LaserParameter& parameter : kLaserParameters) fmt::print(" {} |", parameter.key);
  fmt::print(" placed |\n|---|---|---|---|---|---|---|---|---|\n");
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(mounts); ++seed) {
    const Mounted mount = any_mount(seed);
    print(seed, calibrated(mount, seconds, seed), mount);
  }
  return 0;
}
