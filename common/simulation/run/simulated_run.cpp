#include "voxlist/simulation/run/simulated_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace voxlist::simulation {
namespace {

using Scans = SimulationConfig::Scans;

constexpr double kNever = std::numeric_limits<double>::infinity();
// How long a robot stands when nothing else is said: a minute, as calibration needs (s).
constexpr double kStanding_s = 60.0;

std::int64_t to_utime_us(double t_s) { return std::llround(t_s * 1e6); }

Trajectory motion(const Building& building, const SimulationConfig& config) {
  if (config.stand_in_room < 0)
    return drive(plan_tour(building, config.tour, config.share), config.drive);
  const auto room = static_cast<std::size_t>(config.stand_in_room);
  if (room >= building.rooms.size())
    throw std::invalid_argument("simulation: no such room to stand in");
  const Eigen::Vector2d centre = building.rooms[room].centre();
  return Trajectory(1.0, {Pose2{centre.x(), centre.y(), 0.0}});
}

// What a robot keeps from another's middle at least (m): both have a radius of 0.25 m.
constexpr double kNeverNearer_m = 0.6;

bool meet(const Trajectory& one, const Trajectory& other, double end_s) {
  for (double t_s = 0.0; t_s <= end_s; t_s += 0.1)
    if (distance_m(one.at(t_s), other.at(t_s)) < kNeverNearer_m) return true;
  return false;
}

// The robots that share the building with this one. Each begins elsewhere in the same tour.
std::vector<MovingBody> others(const Building& building, const Trajectory& own, double duration_s,
                               const SimulationConfig& config) {
  std::vector<MovingBody> robots;
  if (config.share.robots > 1 && config.stand_in_room >= 0)
    throw std::invalid_argument("simulation: several robots drive, none of them stands in a room");
  for (int robot = 0; robot < config.share.robots; ++robot) {
    if (robot == config.share.robot) continue;
    Trajectory way =
        drive(plan_tour(building, config.tour, {config.share.robots, robot}), config.drive);
    if (meet(own, way, duration_s))
      throw std::invalid_argument("simulation: robots would run into each other in this building");
    robots.push_back({std::move(way), config.scanner.body});
  }
  return robots;
}

// What the wheels feel of it. A tour takes long to plan: once, if that is enough.
Trajectory felt(const Trajectory& truth, const Building& building, const SimulationConfig& config) {
  if (config.carried.at_s.empty()) return truth;
  return without_carries(motion(building, config), config.carried);
}

OdometryConfig scaled(OdometryConfig config, double errors) {
  config.distance_scale_sd *= errors;
  config.turn_scale_sd *= errors;
  config.distance_noise_m *= errors;
  config.heading_noise_deg *= errors;
  return config;
}

double duration(const Trajectory& truth, const SimulationConfig& config) {
  if (config.duration_s > 0.0) return config.duration_s;
  const bool stays_away = !config.carried.at_s.empty() && config.carried.back_at_s == 0.0;
  if (stays_away) return config.carried.at_s.back() + kStanding_s;
  return truth.duration_s() > 0.0 ? truth.duration_s() : kStanding_s;
}

MirrorScannerConfig with_faults(const SimulationConfig& config) {
  MirrorScannerConfig scanner = config.scanner;
  scanner.motor.faults.push_back(config.motor_fault);
  scanner.latency_s = config.latency_ms * 1e-3;
  return scanner;
}

}  // namespace

SimulatedRun::SimulatedRun(const SimulationConfig& config)
    : SimulatedRun(config, make_building(config.building)) {}

SimulatedRun::SimulatedRun(const SimulationConfig& config, const Building& building)
    : config_(config),
      truth_(with_carries(motion(building, config), config.carried)),
      odometry_(wheel_odometry(felt(truth_, building, config),
                               scaled(config.odometry, config.odometry_errors),
                               static_cast<std::uint64_t>(config.seed))),
      duration_s_(duration(truth_, config)),
      world_(building,
             walk(building, truth_, duration_s_, config.people,
                  static_cast<std::uint64_t>(config.seed)),
             others(building, truth_, duration_s_, config)),
      scanner_(world_, truth_, with_faults(config), static_cast<std::uint64_t>(config.seed)) {}

std::optional<SimulatedEvent> SimulatedRun::next() {
  const std::array<double, 5> due{odometry_s(), truth_s(), edge_s(), line_s(), cloud_s()};
  const auto first = std::min_element(due.begin(), due.end(), [](double a, double b) {
    return a < kNever && (b == kNever || to_utime_us(a) < to_utime_us(b));
  });
  if (*first > duration_s_) return std::nullopt;
  switch (first - due.begin()) {
    case 0:
      return next_odometry();
    case 1:
      return next_truth();
    case 2:
      return next_edge();
    case 3:
      return next_line();
    default:
      return next_cloud();
  }
}

double SimulatedRun::odometry_s() const {
  return static_cast<double>(odometries_) * odometry_.period_s();
}

double SimulatedRun::truth_s() const {
  return config_.scans == Scans::kClouds ? static_cast<double>(truths_ + 1) * config_.sweep.sweep_s
                                         : static_cast<double>(truths_) * odometry_.period_s();
}

double SimulatedRun::edge_s() const {
  return config_.scans == Scans::kLines ? scanner_.motor().edge_s(edges_) : kNever;
}

double SimulatedRun::line_s() const {
  if (config_.scans != Scans::kLines) return kNever;
  return static_cast<double>(lines_) / scanner_.config().turns_per_second +
         scanner_.config().latency_s;
}

double SimulatedRun::cloud_s() const {
  return config_.scans == Scans::kClouds ? static_cast<double>(clouds_ + 1) * config_.sweep.sweep_s
                                         : kNever;
}

SimulatedOdometry SimulatedRun::next_odometry() {
  const double t_s = odometry_s();
  ++odometries_;
  return {{to_utime_us(t_s), odometry_.at(t_s)}};
}

SimulatedTruth SimulatedRun::next_truth() {
  const double t_s = truth_s();
  ++truths_;
  return {{to_utime_us(t_s), truth_.at(t_s)}};
}

SimulatedClockEdge SimulatedRun::next_edge() {
  const double t_s = edge_s();
  const StepperMotor& motor = scanner_.motor();
  do ++edges_;
  while (!motor.clock_seen(edge_s()) && edge_s() <= duration_s_);
  return {to_utime_us(t_s)};
}

LaserLine SimulatedRun::next_line() {
  const double t_s = line_s() - scanner_.config().latency_s;
  ++lines_;
  return scanner_.measure(to_utime_us(t_s));
}

Cloud SimulatedRun::next_cloud() {
  const double t_s = cloud_s();
  ++clouds_;
  return scan_sweep(scanner_, config_.perfect_deskew ? truth_ : odometry_, t_s, config_.sweep,
                    static_cast<std::uint64_t>(config_.seed));
}

}  // namespace voxlist::simulation
