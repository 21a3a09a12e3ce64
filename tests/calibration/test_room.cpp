#include "tests/calibration/test_room.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "voxlist/simulation/random.h"

namespace voxlist::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kWall = 0.12;
constexpr double kPlateHalfWidth_m = 0.05;
constexpr double kLinesPerSecond = 75.0;
constexpr double kMaxRange_m = 8.183;

simulation::Box block(const Vector3d& low, const Vector3d& high, double yaw_rad = 0.0) {
  return {(low + high) / 2.0, (high - low) / 2.0, yaw_rad};
}

void add_shell(TestRoom& room, const Vector3d& low, const Vector3d& high, bool floor = true,
               bool ceiling = true) {
  const Vector3d out_low = low.array() - kWall, out_high = high.array() + kWall;
  const auto add = [&](int axis, bool upper) {
    Vector3d a = out_low, b = out_high;
    if (upper) {
      a[axis] = high[axis];
    } else {
      b[axis] = low[axis];
    }
    room.boxes.push_back(block(a, b));
  };
  for (const int axis : {0, 1})
    for (const bool upper : {false, true}) add(axis, upper);
  if (floor) add(2, false);
  if (ceiling) add(2, true);
}

std::optional<double> range(const Cylinder& c, const Vector3d& from, const Vector3d& to) {
  const Vector2d offset = from.head<2>() - c.centre_m, d = to.head<2>();
  const double a = d.squaredNorm(), b = offset.dot(d);
  const double root = b * b - a * (offset.squaredNorm() - c.radius_m * c.radius_m);
  if (root < 0.0 || a < 1e-12) return std::nullopt;
  const double t = (-b - std::sqrt(root)) / a, z = from.z() + t * to.z();
  if (t < 0.0 || z < c.bottom_m || z > c.top_m) return std::nullopt;
  return t;
}

Cylinder person(const std::pair<Vector2d, Vector2d>& walk, double t_s) {
  const Vector2d way = walk.second - walk.first;
  const double along = std::abs(std::remainder(t_s, 2.0 * way.norm()));
  return {walk.first + along * way.normalized(), 0.22, 0.0, 1.75};
}

class Caster {
 public:
  explicit Caster(const TestRoom& room) : room_(room), tree_(room.boxes) {}

  double range_m(const Vector3d& from, const Vector3d& to, double t_s) const {
    double best = tree_.range(from, to).value_or(std::numeric_limits<double>::infinity());
    const auto consider = [&](const Cylinder& c) {
      best = std::min(best, range(c, from, to).value_or(best));
    };
    for (const Cylinder& cylinder : room_.cylinders) consider(cylinder);
    for (const auto& walk : room_.walks) consider(person(walk, t_s));
    return best;
  }

 private:
  const TestRoom& room_;
  const simulation::BoxTree tree_;
};

// A beam after the mirror (laser frame), or past its edge, straight on.
struct Traced {
  Vector3d from, to;
  double path_m;
  int side;
};

Traced trace(const scanner::ScannerGeometry& g, double psi_rad, double beam_rad,
             double half_width_m) {
  const Eigen::Matrix3d tilt = (Eigen::AngleAxisd(g.axis_yaw_deg * kRadPerDeg, Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(g.axis_roll_deg * kRadPerDeg, Vector3d::UnitX()))
                                   .toRotationMatrix();
  const Vector3d middle(0.0, 0.0, g.mirror_height_m);
  const Vector3d d(0.0, std::cos(beam_rad), std::sin(beam_rad));
  for (const int side : {0, 1}) {
    const double phase_deg = side == 0 ? g.mirror_phase_0_deg : g.mirror_phase_1_deg;
    const double e = side == 0 ? g.mirror_offset_0_m : g.mirror_offset_1_m;
    // The plate lies in its own frame with the side's normal along x, its axis along y.
    const Eigen::Matrix3d turned =
        tilt *
        Eigen::AngleAxisd(-(psi_rad + phase_deg * kRadPerDeg) - side * kPi, Vector3d::UnitY())
            .toRotationMatrix();
    const Vector3d from_plate = turned.transpose() * -middle, d_plate = turned.transpose() * d;
    if (d_plate.x() >= 0.0) continue;
    const double path_m = (e - from_plate.x()) / d_plate.x();
    const Vector3d hit = from_plate + path_m * d_plate;
    if (std::abs(hit.z()) > half_width_m) continue;
    const Vector3d away(-d_plate.x(), d_plate.y(), d_plate.z());
    return {turned * hit + middle, turned * away, path_m, side};
  }
  return {Vector3d::Zero(), d, 0.0, -1};
}

double rate_of(double sweep_s) { return kPi / sweep_s; }

}  // namespace

TestRoom office() {
  TestRoom room{"office", {}, {}, {0.3, -0.2, 0.35}, {{{-1.8, -2.2}, {-1.8, 2.2}}}};
  add_shell(room, {-3.0, -2.6, 0.0}, {3.1, 2.7, 2.65});
  room.boxes.push_back(block({2.7, -2.6, 0.0}, {3.1, -0.8, 1.9}));         // cupboard
  room.boxes.push_back(block({1.4, 1.2, 0.70}, {2.6, 2.0, 0.74}, 0.3));    // table top
  room.boxes.push_back(block({-2.9, -0.4, 0.0}, {-2.6, 0.9, 1.2}));        // shelf
  room.boxes.push_back(block({-3.0, 1.2, 0.9}, {-2.97, 2.2, 1.9}));        // board on the wall
  room.boxes.push_back(block({0.2, 2.55, 0.1}, {1.4, 2.7, 0.8}));          // radiator
  room.boxes.push_back(block({-1.2, -2.3, 0.0}, {-0.7, -1.8, 0.9}, 0.7));  // chair
  room.cylinders.push_back({{2.2, 0.5}, 0.18, 0.0, 0.5});
  room.cylinders.push_back({{-0.9, 1.6}, 0.25, 0.0, 0.9});
  room.cylinders.push_back({{0.5, -1.2}, 0.2, 2.2, 2.5});
  return room;
}

TestRoom corridor() {
  TestRoom room{"corridor", {}, {}, {0.0, 0.1, -0.1}, {{{2.0, 0.5}, {6.0, 0.5}}}};
  add_shell(room, {-4.0, -4.0, 0.0}, {9.0, 4.0, 2.5});
  const double half = 1.1;
  for (const auto& [from, to] : {std::pair{-4.0, -1.5}, {-0.5, 3.0}, {4.0, 9.0}}) {
    room.boxes.push_back(block({from, half, 0.0}, {to, half + kWall, 2.5}));
  }
  for (const auto& [from, to] : {std::pair{-4.0, 1.0}, {2.0, 6.0}, {7.0, 9.0}}) {
    room.boxes.push_back(block({from, -half - kWall, 0.0}, {to, -half, 2.5}));
  }
  room.boxes.push_back(block({4.6, -half, 0.0}, {5.8, -half + 0.35, 1.6}));
  room.boxes.push_back(block({1.0, -half, 2.0}, {2.0, -half + 0.05, 2.5}));
  room.cylinders.push_back({{-2.5, -0.8}, 0.15, 0.0, 0.7});
  room.cylinders.push_back({{3.3, 0.8}, 0.25, 0.0, 1.5});
  return room;
}

TestRoom hall() {
  TestRoom room{
      "hall", {}, {}, {-1.0, 0.5, 1.2}, {{{1.0, -2.5}, {1.0, 2.5}}, {{-3.0, 2.0}, {0.0, 3.0}}}};
  add_shell(room, {-5.0, -4.5, 0.0}, {6.0, 4.5, 3.2});
  room.boxes.push_back(block({-8.0, 2.6, 0.0}, {-2.0, 4.6, 3.2}, 0.6));  // slanted corner
  room.boxes.push_back(block({3.0, -4.5, 0.0}, {6.0, -2.0, 3.2}));       // L
  room.boxes.push_back(block({-5.0, -1.0, 2.7}, {6.0, -0.6, 3.2}));      // beam
  room.boxes.push_back(block({0.5, 3.4, 0.0}, {2.9, 3.9, 1.4}, -0.2));
  room.boxes.push_back(block({-3.6, -3.6, 0.72}, {-2.0, -2.6, 0.75}, 0.5));
  room.boxes.push_back(block({-3.0, -3.3, 0.0}, {-2.6, -2.9, 0.72}, 0.5));
  for (const double x : {-2.5, 1.8}) room.cylinders.push_back({{x, -1.9}, 0.25, 0.0, 3.2});
  room.cylinders.push_back({{4.5, 1.5}, 0.5, 0.0, 1.0});
  return room;
}

TestRoom box_room(const Vector3d& size, bool floor, bool ceiling) {
  TestRoom room{"box", {}, {}, {0.2, -0.3, 0.1}, {}};
  add_shell(room, {-size.x() / 2, -size.y() / 2, 0.0}, {size.x() / 2, size.y() / 2, size.z()},
            floor, ceiling);
  return room;
}

TestRoom lone_wall() {
  TestRoom room{"lone wall", {}, {}, {0.0, 0.0, 0.0}, {}};
  room.boxes.push_back(block({3.0, -1.5, 0.0}, {3.1, 1.5, 2.4}));
  return room;
}

calibration::CalibrationInput record(const TestRoom& room, const RecordingOptions& options) {
  const Caster caster(room);
  simulation::Random random(options.seed);
  const scanner::ScannerGeometry& truth = options.truth;
  const Pose3 T_map_laser = to_pose3(room.T_map_base) * truth.T_base_laser();
  const int lines = static_cast<int>(options.duration_s * kLinesPerSecond);
  calibration::CalibrationInput input;
  for (int i = 0; i < lines; ++i) {
    const auto part =
        static_cast<std::size_t>(i) * options.sweeps_s.size() / static_cast<std::size_t>(lines);
    const double rate = rate_of(options.sweeps_s[part]);
    LaserLine line;
    line.utime_us = 1'000'000 + std::llround(i * 1e6 / kLinesPerSecond);
    MirrorState mirror;
    mirror.utime_us = line.utime_us - 2000;
    mirror.state = MirrorState::State::kLocked;
    mirror.angle_known = true;
    mirror.angle_rad = std::fmod(rate * 1e-6 * static_cast<double>(mirror.utime_us), 2.0 * kPi);
    mirror.rate_radps = rate;
    for (std::size_t beam = 0; beam <= 180; ++beam) {
      line.ranges_m.push_back(std::numeric_limits<float>::quiet_NaN());
      if (beam < 25 || beam > 155) continue;
      const double t_s = static_cast<double>(line.utime_us) * 1e-6 +
                         beam_delay_us(line, beam) * 1e-6 - truth.latency_ms * 1e-3;
      const Traced ray =
          trace(truth, rate * t_s, static_cast<double>(beam) * kRadPerDeg, kPlateHalfWidth_m);
      if (options.single_sided && ray.side == 1) continue;
      const double beyond_m =
          caster.range_m(T_map_laser * ray.from, T_map_laser.linear() * ray.to, t_s);
      const double range_m = ray.path_m + beyond_m + options.range_sd_m * random.normal();
      line.ranges_m.back() = range_m < kMaxRange_m
                                 ? static_cast<float>(std::round(range_m * 1e3) / 1e3)
                                 : std::numeric_limits<float>::infinity();
    }
    input.lines.push_back(std::move(line));
    input.mirror.push_back(mirror);
  }
  return input;
}

SystematicError systematic_error(const scanner::ScannerGeometry& found,
                                 const scanner::ScannerGeometry& truth, double sweep_s) {
  constexpr double kFar_m = 6.0, kBlind_deg = 7.5;
  const double rate = rate_of(sweep_s);
  const scanner::MirrorModel<> model = found.model();
  SystematicError error;
  int count = 0;
  for (int psi_deg = 0; psi_deg < 360; psi_deg += 3)
    for (int beam_deg = 25; beam_deg <= 155; beam_deg += 5) {
      const double psi = psi_deg * kRadPerDeg, beam = beam_deg * kRadPerDeg;
      if (std::abs(std::sin(psi)) < std::sin(kBlind_deg * kRadPerDeg)) continue;
      const Traced is = trace(truth, psi - rate * truth.latency_ms * 1e-3, beam, 1.0);
      const auto said = model.reflect(psi - rate * found.latency_ms * 1e-3, beam);
      const Vector3d point = truth.T_base_laser() * Vector3d(is.from + kFar_m * is.to);
      const Vector3d shown =
          found.T_base_laser() *
          Vector3d(said.origin_m + (is.path_m + kFar_m - said.path_m) * said.direction);
      const double distance_m = (shown - point).norm();
      error.rms_m += distance_m * distance_m;
      error.max_m = std::max(error.max_m, distance_m);
      ++count;
    }
  error.rms_m = std::sqrt(error.rms_m / count);
  return error;
}

scanner::ScannerGeometry miscalibrated() {
  scanner::ScannerGeometry geometry;
  geometry.mirror_phase_0_deg = 0.25;
  geometry.mirror_phase_1_deg = -0.2;
  geometry.mirror_height_m += 0.005;
  geometry.mirror_offset_0_m += 0.002;
  geometry.mirror_offset_1_m -= 0.002;
  geometry.axis_yaw_deg = 0.3;
  geometry.axis_roll_deg = -0.3;
  geometry.latency_ms = 1.0;
  return geometry;
}

}  // namespace voxlist::test
