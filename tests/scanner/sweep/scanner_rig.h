#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/scanner/mirror/physical_mirror.h"
#include "voxlist/geometry/laser_line.h"
#include "voxlist/geometry/mirror_state.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/scanner/sweep/cloud_assembler_config.h"
#include "voxlist/simulation/building/box_tree.h"

namespace voxlist::scanner {

/// A room 6 m x 5 m x 2.75 m with a box in it. The robot starts in its middle.
inline simulation::BoxTree rig_room() {
  const auto box = [](double x, double y, double z, double half_x, double half_y, double half_z) {
    return simulation::Box{{x, y, z}, {half_x, half_y, half_z}, 0.0};
  };
  return simulation::BoxTree({box(0, 0, -0.1, 4, 4, 0.1), box(0, 0, 2.85, 4, 4, 0.1),
                              box(3.1, 0, 1.4, 0.1, 4, 2), box(-3.1, 0, 1.4, 0.1, 4, 2),
                              box(0, 2.6, 1.4, 4, 0.1, 2), box(0, -2.6, 1.4, 4, 0.1, 2),
                              box(-2, 1, 0.4, 0.4, 0.3, 0.4)});
}

/// A real scanner for the assembler to make clouds of: light goes from the laser to the plate and
/// into the room, every beam at its own time. Noise-free. Times start at kStart_us.
struct ScannerRig {
  static constexpr std::int64_t kStart_us = 1'700'000'000'000'000;
  static constexpr double kPi = std::numbers::pi;
  static constexpr double kHalfStep_rad = 2.0 * kPi / 400.0;

  // mirror_phase_0_deg and so on of `geometry` are the truth here.
  ScannerGeometry geometry;
  double sweep_s = 1.0;
  double direction = 1.0;  ///< of the mirror's turning
  double psi_0_rad = 0.3;  ///< at the start
  bool staircase = false;
  double line_period_us = kLaserTurn_us;
  std::function<Pose2(double t_s)> T_world_base = [](double) { return Pose2{}; };
  simulation::BoxTree room = rig_room();

  double rate_radps() const { return direction * kPi / sweep_s; }

  double psi_rad(double t_s) const {
    const double turned_rad = rate_radps() * t_s;
    if (!staircase) return psi_0_rad + turned_rad;
    return psi_0_rad +
           std::copysign(std::floor(std::abs(turned_rad) / kHalfStep_rad + 1e-9), turned_rad) *
               kHalfStep_rad;
  }

  static double seconds(std::int64_t utime_us) {
    return static_cast<double>(utime_us - kStart_us) * 1e-6;
  }

  // 11 us off the motor's steps: a beam that left just as the mirror jumped would prove nothing.
  std::int64_t line_utime_us(int index) const {
    return kStart_us + 11 + std::llround(index * line_period_us);
  }

  /// Line number `index`; the laser's clock is right by default.
  LaserLine line(int index, double first_angle_deg = 0.0) const {
    LaserLine line;
    line.utime_us = line_utime_us(index);
    line.first_angle_rad = first_angle_deg * kPi / 180.0;
    const int beams = first_angle_deg == 0.0 ? 181 : 180;
    for (int i = 0; i < beams; ++i) {
      const auto beam = static_cast<std::size_t>(i);
      const double t_s = seconds(line.utime_us) + beam_delay_us(line, beam) * 1e-6;
      line.ranges_m.push_back(range_m(t_s, line.angle_rad(beam)));
    }
    return line;
  }

  /// What a monitor with a clock says: the last edge before the line's first beam.
  MirrorState mirror(int index) const {
    MirrorState state;
    const double t_s = seconds(line_utime_us(index));
    const double step_s = kHalfStep_rad / std::abs(rate_radps());
    const double edge_s = std::floor(t_s / step_s + 1e-9) * step_s;
    state.utime_us = kStart_us + std::llround(edge_s * 1e6);
    state.state = MirrorState::State::kLocked;
    state.angle_known = true;
    const double psi = psi_rad(edge_s + 1e-9), turn = 2.0 * kPi;
    state.angle_rad = psi - turn * std::floor(psi / turn);
    state.rate_radps = rate_radps();
    state.step_rad = kHalfStep_rad;
    return state;
  }

  StampedPose2 odometry(std::int64_t utime_us) const {
    return {utime_us, T_world_base(seconds(utime_us))};
  }

  /// Distance of a point, given in base at a time, from the room's true surfaces.
  double error_m(std::int64_t utime_us, const Eigen::Vector3f& point_base) const {
    const Eigen::Vector3d point = T_world_base(seconds(utime_us)) * point_base.cast<double>();
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const simulation::Box& box : room.boxes())
      nearest_m = std::min(nearest_m, box.surface_distance_m(point));
    return nearest_m;
  }

 private:
  float range_m(double t_s, double beam_rad) const {
    const double radians = kPi / 180.0;
    const PhysicalMirror mirror(
        {.height_m = geometry.mirror_height_m,
         .offset_m = {geometry.mirror_offset_0_m, geometry.mirror_offset_1_m},
         .phase_rad = {geometry.mirror_phase_0_deg * radians,
                       geometry.mirror_phase_1_deg * radians},
         .yaw_rad = geometry.axis_yaw_deg * radians,
         .roll_rad = geometry.axis_roll_deg * radians},
        psi_rad(t_s));
    const Eigen::Vector3d ray(0.0, std::cos(beam_rad), std::sin(beam_rad));
    const Pose3 T_world_laser = to_pose3(T_world_base(t_s)) * geometry.T_base_laser();
    const auto bounce = mirror.trace(ray);
    constexpr double kHalfLength_m = 0.25;
    const bool meets = bounce && std::abs(bounce->hit.y()) <= kHalfLength_m;
    const double path_m = meets ? bounce->hit.norm() : 0.0;
    const Eigen::Vector3d from = meets ? bounce->hit : Eigen::Vector3d::Zero().eval();
    const Eigen::Vector3d along = T_world_laser.linear() * (meets ? bounce->direction : ray);
    const auto reach_m = room.range(T_world_laser * from, along.normalized());
    return reach_m ? static_cast<float>(path_m + *reach_m) : std::numeric_limits<float>::infinity();
  }
};

}  // namespace voxlist::scanner
