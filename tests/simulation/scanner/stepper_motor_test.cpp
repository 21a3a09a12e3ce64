#include "voxlist/simulation/scanner/stepper_motor.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

namespace voxlist::simulation {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

double degrees(const StepperMotor& motor, double t_s) { return motor.angle_rad(t_s) / kRadPerDeg; }

StepperMotorConfig from_zero() {
  StepperMotorConfig config;
  config.start_deg = 0.0;
  return config;
}

TEST(StepperMotor, TurnsTheMirrorHalfRoundInASweep) {
  StepperMotorConfig config;
  config.start_deg = 20.0;
  config.sweep_s = {3.0};
  const StepperMotor motor(config);
  EXPECT_NEAR(degrees(motor, 0.0), 20.0, 1e-9);
  EXPECT_NEAR(degrees(motor, 3.0), 200.0, 1e-9);
  EXPECT_NEAR(degrees(motor, -1.5), -70.0, 1e-9);
}

TEST(StepperMotor, IsAtEachStepsPlaceWhenItsEdgeComes) {
  StepperMotorConfig config = from_zero();
  const StepperMotor smooth(config);
  config.staircase = true;
  const StepperMotor staircase(config);
  for (const int edge : {0, 1, 7, 399, 400, 123'456}) {
    const double t_s = smooth.edge_s(edge);
    EXPECT_NEAR(t_s, edge * 0.005, 1e-9);
    EXPECT_NEAR(degrees(smooth, t_s), edge * 0.9, 1e-6);
    EXPECT_NEAR(degrees(staircase, t_s), edge * 0.9, 1e-6);
    EXPECT_NEAR(degrees(smooth, t_s + 0.004), (edge + 0.8) * 0.9, 1e-6);
    EXPECT_NEAR(degrees(staircase, t_s + 0.004), edge * 0.9, 1e-6);
  }
}

TEST(StepperMotor, ChangesItsSpeedWithoutAJump) {
  StepperMotorConfig config = from_zero();
  config.sweep_s = {1.0, 3.0};
  config.from_s = {0.0, 10.001};
  const StepperMotor motor(config);
  EXPECT_NEAR(degrees(motor, 10.001), 1800.18, 1e-6);
  EXPECT_NEAR(degrees(motor, 13.001), 1980.18, 1e-6);
  EXPECT_NEAR(motor.edge_s(2000), 10.0, 1e-9);
  EXPECT_NEAR(degrees(motor, motor.edge_s(2001)), 2001 * 0.9, 1e-6);
  EXPECT_NEAR(motor.edge_s(2002) - motor.edge_s(2001), 0.015, 1e-9);
}

TEST(StepperMotor, TurnsTheOtherWayWhenItIsReversed) {
  StepperMotorConfig config = from_zero();
  config.reversed = true;
  EXPECT_NEAR(degrees(StepperMotor(config), 1.0), -180.0, 1e-9);
}

TEST(StepperMotor, StallsMissesStepsAndTurnsBackWhileItsClockGoesOn) {
  StepperMotorConfig config = from_zero();
  config.faults = {{.from_s = 1.0, .to_s = 1.5, .gain = 0.0},
                   {.from_s = 3.0, .to_s = 3.0, .missed_steps = 8.0},
                   {.from_s = 5.0, .to_s = 5.25, .gain = -1.0}};
  const StepperMotor motor(config);
  EXPECT_NEAR(degrees(motor, 1.0), 180.0, 1e-9);
  EXPECT_NEAR(degrees(motor, 1.4), 180.0, 1e-9);
  EXPECT_NEAR(degrees(motor, 2.5), 360.0, 1e-9);
  EXPECT_NEAR(degrees(motor, 4.0), 630.0 - 7.2, 1e-9);
  EXPECT_NEAR(degrees(motor, 5.25), 810.0 - 7.2 - 45.0, 1e-9);
  EXPECT_NEAR(degrees(motor, 6.25), 990.0 - 7.2 - 45.0, 1e-9);
  EXPECT_NEAR(motor.edge_s(1000), 5.0, 1e-9);
}

TEST(StepperMotor, TurnsOnWhenOnlyItsClocksLineIsLost) {
  StepperMotorConfig config = from_zero();
  config.faults = {{.from_s = 1.0, .to_s = 2.0, .clock_lost = true}};
  const StepperMotor motor(config);
  EXPECT_NEAR(degrees(motor, 2.0), 360.0, 1e-9);
  EXPECT_TRUE(motor.clock_seen(0.99));
  EXPECT_FALSE(motor.clock_seen(1.5));
  EXPECT_TRUE(motor.clock_seen(2.0));
}

TEST(StepperMotor, RefusesSpeedsThatMakeNoSense) {
  StepperMotorConfig config;
  config.sweep_s = {};
  EXPECT_THROW(StepperMotor{config}, std::invalid_argument);
  config.sweep_s = {1.0, 3.0};
  EXPECT_THROW(StepperMotor{config}, std::invalid_argument);
  config.from_s = {0.0, -1.0};
  EXPECT_THROW(StepperMotor{config}, std::invalid_argument);
  config = {};
  config.sweep_s = {0.0};
  EXPECT_THROW(StepperMotor{config}, std::invalid_argument);
}

}  // namespace
}  // namespace voxlist::simulation
