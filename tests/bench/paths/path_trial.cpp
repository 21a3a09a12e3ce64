#include "tests/bench/paths/path_trial.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "tests/simulation/sphere_scan.h"
#include "voxlist/simulation/scanner/ideal_sweep.h"
#include "voxlist/simulation/world/robot.h"
#include "voxlist/simulation/world/tour.h"

namespace voxlist::bench {
namespace {

// Paths are looked at so often (m).
constexpr double kStep_m = 0.02;
// The nearest that start and goal are to each other (m).
constexpr double kFarApart_m = 2.0;
constexpr int kTries = 100'000;

Eigen::Vector2d random_spot(const Area& area, simulation::Random& random) {
  const double x = random.uniform(area.low.x(), area.high.x());
  return {x, random.uniform(area.low.y(), area.high.y())};
}

template <class Is>
bool is_all_along(const std::vector<Eigen::Vector2d>& path, const Is& is) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector2d leg = path[i] - path[i - 1];
    const auto steps = static_cast<int>(std::ceil(leg.norm() / kStep_m));
    for (int s = 0; s <= steps; ++s)
      if (!is(path[i - 1] + leg * s / std::max(1, steps))) return false;
  }
  return true;
}

}  // namespace

std::vector<PosedScan> scans_along_tour(const simulation::Building& building, double spacing_m,
                                        std::uint64_t seed) {
  const std::vector<Eigen::Vector2d> tour = simulation::plan_tour(building, {});
  const simulation::World world(building);
  simulation::SphereScanConfig laser;
  laser.rays = 16'000;
  std::vector<PosedScan> scans;
  double way_m = spacing_m;
  for (std::size_t i = 1; i < tour.size(); ++i) {
    way_m += (tour[i] - tour[i - 1]).norm();
    if (way_m < spacing_m) continue;
    way_m = 0.0;
    const Pose2 pose{tour[i].x(), tour[i].y(), 0.1 * static_cast<double>(i)};
    scans.push_back({pose, simulation::scan_sphere(world, pose, laser, seed + i)});
  }
  return scans;
}

std::vector<PosedScan> mirror_scans_along_tour(const simulation::Building& building,
                                               std::uint64_t seed) {
  const simulation::Trajectory way =
      simulation::drive(simulation::plan_tour(building, {}), simulation::DriveConfig{});
  const simulation::World world(building);
  const simulation::MirrorScanner scanner(world, way, {}, seed);
  std::vector<PosedScan> scans;
  for (double t_s = 1.0; t_s < way.duration_s(); t_s += 1.0)
    scans.push_back({way.at(t_s), simulation::scan_sweep(scanner, way, t_s, {}, seed)});
  return scans;
}

Area area_of(const simulation::Building& building) {
  Area area{building.rooms.front().low, building.rooms.front().high};
  for (const simulation::Room& room : building.rooms) {
    area.low = area.low.cwiseMin(room.low);
    area.high = area.high.cwiseMax(room.high);
  }
  return area;
}

Errand random_errand(const simulation::Building& building, const FreeCells& known, const Body& body,
                     simulation::Random& random) {
  const Area area = area_of(building);
  const auto spot = [&] {
    for (int i = 0; i < kTries; ++i) {
      const Eigen::Vector2d point = random_spot(area, random);
      const double room_m = body.radius_m + body.margin_m;
      if (building.clearance_m(point, body.low_m, body.high_m) > room_m + kStep_m &&
          known.hold(point, room_m + 2.0 * kStep_m))
        return point;
    }
    throw std::runtime_error("no room for the robot in this building");
  };
  Errand errand{spot(), spot()};
  while ((errand.goal - errand.start).norm() < kFarApart_m) errand.goal = spot();
  return errand;
}

std::vector<Eigen::Vector2d> points_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> out(popen(command.c_str(), "r"), pclose);
  if (!out) throw std::runtime_error("cannot run " + command);
  std::vector<Eigen::Vector2d> points;
  for (double x, y; std::fscanf(out.get(), "%lf %lf", &x, &y) == 2;) points.emplace_back(x, y);
  return points;
}

void PathTally::add(const Errand& errand, const std::vector<Eigen::Vector2d>& path,
                    const simulation::Building& building, const FreeCells& known,
                    const Body& body) {
  const bool is_way = known.lead(errand.start, errand.goal, body.radius_m + body.margin_m);
  ++errands;
  ways += is_way;
  missed += is_way && path.empty();
  if (path.empty()) return;
  ++found;
  collided += !is_all_along(path, [&](const Eigen::Vector2d& at) {
    return building.clearance_m(at, body.low_m, body.high_m) >= body.radius_m;
  });
  through_unknown +=
      !is_all_along(path, [&](const Eigen::Vector2d& at) { return known.hold(at, body.radius_m); });
}

}  // namespace voxlist::bench
