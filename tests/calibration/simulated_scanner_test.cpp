// Against the simulator's scanner: its own physics with arms and body, MIRROR by the monitor's own
// class, people in the room.
#include <gmock/gmock.h>

#include <variant>

#include "tests/calibration/test_room.h"
#include "voxlist/calibration/calibrate.h"
#include "voxlist/scanner/mirror/mirror_clock.h"
#include "voxlist/simulation/run/simulated_run.h"

namespace voxlist::calibration {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

simulation::SimulationConfig simulation(const scanner::ScannerGeometry& truth, int seed) {
  simulation::SimulationConfig config;
  config.scans = simulation::SimulationConfig::Scans::kLines;
  config.seed = config.building.seed = seed;
  config.stand_in_room = 0;
  config.duration_s = 60.0;
  config.people.count = 2;
  config.latency_ms = truth.latency_ms;
  simulation::TurningMirrorConfig& mirror = config.scanner.mirror;
  mirror.phase_deg = {truth.mirror_phase_0_deg, truth.mirror_phase_1_deg};
  mirror.height_m = truth.mirror_height_m;
  mirror.offset_m = {truth.mirror_offset_0_m, truth.mirror_offset_1_m};
  mirror.axis_yaw_deg = truth.axis_yaw_deg;
  mirror.axis_roll_deg = truth.axis_roll_deg;
  return config;
}

class Recorder {
 public:
  explicit Recorder(const simulation::TurningMirrorConfig& mirror) : clock_(clock_of(mirror)) {}

  void operator()(const simulation::SimulatedOdometry& event) {
    input.odometry.push_back(event.measured);
  }
  void operator()(const simulation::SimulatedTruth&) {}
  void operator()(const simulation::SimulatedClockEdge& event) { clock_.add_edge(event.utime_us); }
  void operator()(const LaserLine& line) {
    input.lines.push_back(line);
    input.mirror.push_back(clock_.add_line(line));
  }
  void operator()(const Cloud&) {}

  CalibrationInput input;

 private:
  static scanner::MirrorClockConfig clock_of(const simulation::TurningMirrorConfig& mirror) {
    scanner::MirrorClockConfig clock;
    for (const simulation::ArmRod& arm : mirror.arms)
      clock.arms.push_back({arm.angle_deg * kRadPerDeg, arm.beam_first_deg * kRadPerDeg,
                            arm.beam_last_deg * kRadPerDeg});
    return clock;
  }

  scanner::MirrorClock clock_;
};

CalibrationInput record(const simulation::SimulationConfig& config) {
  simulation::SimulatedRun run(config);
  Recorder recorder(config.scanner.mirror);
  while (const auto event = run.next()) std::visit(recorder, *event);
  return std::move(recorder.input);
}

// MIRROR's phase comes from the arms as LASER sees them, so it is as late as LASER: between the two
// there is no latency left.
scanner::ScannerGeometry as_mirror_sees(scanner::ScannerGeometry truth) {
  truth.latency_ms = 0.0;
  return truth;
}

class SimulatedScanner : public testing::TestWithParam<int> {
 protected:
  static scanner::ScannerGeometry truth() {
    scanner::ScannerGeometry geometry = test::miscalibrated();
    geometry.mirror_offset_1_m = 0.001;  // the plate is no thinner
    return geometry;
  }
};

TEST_P(SimulatedScanner, IsWithinACentimetreAtSixMetresAfterwards) {
  const Calibration result = calibrate(record(simulation(truth(), GetParam())), {}, {});
  ASSERT_THAT(result.refusals, IsEmpty());
  const scanner::ScannerGeometry found =
      calibration::with_parameters({}, result.answer->parameters);
  const scanner::ScannerGeometry seen = as_mirror_sees(truth());
  const test::SystematicError after = test::systematic_error(found, seen, 1.0);
  RecordProperty("max_error_m", std::to_string(after.max_m));
  EXPECT_GT(test::systematic_error({}, seen, 1.0).max_m, 0.07);
  EXPECT_LT(after.max_m, 0.01);
  EXPECT_LT(result.answer->thickness_after_m, 0.005);
}

TEST_P(SimulatedScanner, IsCalibratedAtTwoSpeeds) {
  simulation::SimulationConfig config = simulation(truth(), GetParam());
  config.scanner.motor.sweep_s = {1.0, 3.0};
  config.scanner.motor.from_s = {0.0, 30.0};
  const Calibration result = calibrate(record(config), {}, {});
  ASSERT_THAT(result.refusals, IsEmpty());
  const scanner::ScannerGeometry found =
      calibration::with_parameters({}, result.answer->parameters);
  for (const double sweep_s : {1.0, 3.0})
    EXPECT_LT(test::systematic_error(found, as_mirror_sees(truth()), sweep_s).max_m, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Buildings, SimulatedScanner, testing::Values(1, 2, 3));

}  // namespace
}  // namespace voxlist::calibration
