#pragma once

#include <string>

#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/scanner/ideal_sweep.h"
#include "voxlist/simulation/scanner/mirror_scanner.h"
#include "voxlist/simulation/world/carried.h"
#include "voxlist/simulation/world/people.h"
#include "voxlist/simulation/world/robot.h"
#include "voxlist/simulation/world/tour.h"

namespace voxlist::simulation {

/// A whole simulated run. Equal configs give equal bits.
struct SimulationConfig {
  /// What of the scanner a run yields by itself.
  enum class Scans {
    kClouds,   ///< ideal sweeps, ready made
    kLines,    ///< the laser's lines and the clock's edges
    kNothing,  ///< for a simulated device that asks for its lines itself
  };

  Scans scans = Scans::kClouds;
  int seed = 1;
  double duration_s = 0.0;
  int stand_in_room = -1;
  CarriedConfig carried;
  bool perfect_deskew = false;
  BuildingConfig building;
  PeopleConfig people;
  TourConfig tour;
  TourShare share;
  DriveConfig drive;
  OdometryConfig odometry;
  double odometry_errors = 1.0;
  MirrorScannerConfig scanner;
  MotorFault motor_fault;
  double latency_ms = 0.0;
  IdealSweepConfig sweep;

  /// What a settings file may choose; the rest is for tests.
  template <class Visitor>
  void visit(Visitor& v) {
    v("seed", seed, "of the errors of wheels and laser, and of people's ways", 0, 1'000'000'000);
    v("duration_s", duration_s, "0: until the tour is back at its start (standing: 60 s)", 0.0,
      86'400.0);
    v("stand_in_room", stand_in_room, "stands in the middle of this room; -1: drives the tour", -1,
      99);
    v("carried_at_s", carried.at_s,
      "at each of these times of the run somebody puts the robot elsewhere, where it then stands; "
      "its wheels measure nothing of it",
      0.0, 86'400.0);
    v("carried_x_m", carried.x_m,
      "where to, in the building (the start is its origin, the corridor its x), one for each time",
      -1000.0, 1000.0);
    v("carried_y_m", carried.y_m, "and y", -1000.0, 1000.0);
    v("put_back_at_s", carried.back_at_s,
      "it is put back where it was carried off, and drives on; 0: never", 0.0, 86'400.0);
    v("wait_s", drive.wait_s, "stands at its start before it drives: time for the first cloud", 0.0,
      3600.0);
    v("building_seed", building.seed, "of the building", 0, 1'000'000'000);
    v("changed", building.changed, "not 0: the same building later: furniture is moved, gone, new",
      0, 1'000'000'000);
    v("rooms", building.rooms, "left and right of the corridor", 0, 100);
    v("length_m", building.length_m, "of the building, along the corridor", 5.0, 500.0);
    v("depth_m", building.depth_m, "of the building, across the corridor", 5.0, 100.0);
    v("height_m", building.height_m, "floor to ceiling", 2.2, 20.0);
    v("corridor_width_m", building.corridor_width_m, "wall to wall", 1.0, 20.0);
    v("furniture_per_room", building.furniture_per_room, "tried for", 0, 1000);
    v("stairs", building.stairs, "flights of stairs down, in rooms", 0, 10);
    v("pipes", building.pipes, "rooms with a pipe across a corner; any: one in the corridor too", 0,
      100);
    v("alike", building.alike,
      "not 0: one room, of this seed, for all, as in a hotel; needs an even `rooms`", 0,
      1'000'000'000);
    v("objects", building.objects, "small things on each room's floor, tried for", 0, 100);
    v("robots", share.robots,
      "that share the building, each elsewhere in the same tour, and see each other", 1, 10);
    v("robot", share.robot, "which of them this one is, from 0", 0, 9);
    v("people", people.count, "who walk from room to room", 0, 50);
    v("odometry_errors", odometry_errors, "times the wheels' usual errors; 0: they are perfect",
      0.0, 100.0);
    visit_scanner(v);
    visit_ideal(v);
  }

 private:
  template <class Visitor>
  void visit_scanner(Visitor& v) {
    TurningMirrorConfig& mirror = scanner.mirror;
    StepperMotorConfig& motor = scanner.motor;
    v("range_max_m", scanner.range_max_m, "of the laser; 8.183 is an LMS 200's in mm", 1.0, 100.0);
    v("range_sd_m", scanner.range_sd_m, "noise of the laser", 0.0, 1.0);
    v("turns_per_second", scanner.turns_per_second, "of the laser; nominally 75", 70.0, 80.0);
    v("sweep_s", motor.sweep_s, "the beam once round, for each part of the run", 0.1, 100.0);
    v("sweep_from_s", motor.from_s, "when each of sweep_s begins; the first at 0", 0.0, 86'400.0);
    v("staircase", motor.staircase, "the mirror stands between the motor's steps");
    v("mirror_phase_0_deg", mirror.phase_deg[0], "side 0, true angle minus the arms' idea", -10.0,
      10.0);
    v("mirror_phase_1_deg", mirror.phase_deg[1], "side 1", -10.0, 10.0);
    v("mirror_height_m", mirror.height_m, "mirror axis above the optical centre", 0.07, 0.3);
    v("mirror_offset_0_m", mirror.offset_m[0], "side 0: its surface from the axis", 0.001, 0.02);
    v("mirror_offset_1_m", mirror.offset_m[1], "side 1", 0.001, 0.02);
    v("mirror_flex_deg", mirror.flex_deg, "the plate is off by this times sin(angle)", -10.0, 10.0);
    v("axis_yaw_deg", mirror.axis_yaw_deg, "the axis turned about z", -10.0, 10.0);
    v("axis_roll_deg", mirror.axis_roll_deg, "and about x", -10.0, 10.0);
    v("latency_ms", latency_ms, "the laser's lines are late by this against the clock", 0.0, 100.0);
    v("motor_reversed", motor.reversed, "turns the other way");
    v("motor_fault_from_s", motor_fault.from_s, "the motor stops following its clock at this time",
      0.0, 86'400.0);
    v("motor_fault_to_s", motor_fault.to_s, "and follows it again from this time on", 0.0,
      86'400.0);
    v("motor_fault_gain", motor_fault.gain,
      "steps for each edge in between: 0 stalls, -1 turns back", -1.0, 1.0);
    v("motor_missed_steps", motor_fault.missed_steps, "steps lost at once when the fault begins",
      0.0, 400.0);
    v("clock_lost", motor_fault.clock_lost,
      "during the fault no edge is seen, though the motor turns");
  }

  template <class Visitor>
  void visit_ideal(Visitor& v) {
    v("perfect_deskew", perfect_deskew,
      "clouds of voxlist simulate, and ideal ones, are put together by the true motion, not by "
      "what the wheels measured");
    v("cloud_range_max_m", sweep.range_max_m, "ideal clouds have no points farther away", 1.0,
      100.0);
    v("cloud_range_sd_m", sweep.range_sd_m,
      "noise of ideal clouds along the beam, standard deviation", 0.0, 1.0);
  }
};

}  // namespace voxlist::simulation
