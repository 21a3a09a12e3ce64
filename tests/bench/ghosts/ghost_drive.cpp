#include "tests/bench/ghosts/ghost_drive.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tests/bench/test_floor.h"
#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"
#include "voxlist/simulation/building/floor_plan.h"
#include "voxlist/simulation/world/people.h"
#include "voxlist/simulation/world/tour.h"

namespace voxlist::bench {
namespace {

using simulation::Box;
using simulation::Building;

constexpr double kSpeed_mps = 0.5, kPeriod_s = 0.1, kScanEvery_s = 1.0;
// Range noise is 15 mm: what was met so much nearer (m) is something else.
constexpr double kNearer_m = 0.06;

bool same(const Box& a, const Box& b) {
  return a.centre_m == b.centre_m && a.half_m == b.half_m && a.yaw_rad == b.yaw_rad;
}

Building with(const Building& building, const std::vector<Box>& more) {
  std::vector<Box> boxes = building.solid.boxes();
  boxes.insert(boxes.end(), more.begin(), more.end());
  return {simulation::BoxTree(std::move(boxes)), building.rooms, building.holes};
}

// Poles in rooms' corners, signs across the corridor under its ceiling, a mesh before a wall.
std::vector<Box> thin_things(const Building& building) {
  std::vector<Box> boxes;
  for (const simulation::Room& room : building.rooms) {
    const Eigen::Vector2d at = room.low + Eigen::Vector2d(0.35, 0.35);
    boxes.push_back(simulation::standing(at, {0.04, 0.04, 2.5}));
    const Eigen::Vector2d sign(room.door.x() + 0.8, 0.0);
    boxes.push_back(simulation::block({sign.x(), -0.4, 2.1}, {sign.x() + 0.02, 0.4, 2.4}));
  }
  const simulation::Room& room = building.rooms.front();
  for (int i = 0; i < 12; ++i) {
    const double x = room.high.x() - 1.4 + 0.1 * i, y = room.high.y() - 0.3;
    boxes.push_back(simulation::block({x, y, 0.3}, {x + 0.01, y + 0.01, 1.5}));
    const double z = 0.3 + 0.1 * i;
    boxes.push_back(
        simulation::block({room.high.x() - 1.4, y, z}, {room.high.x() - 0.3, y + 0.01, z + 0.01}));
  }
  return boxes;
}

// A leaf in each doorway, hinged at its side, in the room; wide open, or less.
std::vector<Box> doors(const Building& building, double open_rad) {
  std::vector<Box> boxes;
  for (const simulation::Room& room : building.rooms) {
    const double into = room.centre().y() > room.door.y() ? 1.0 : -1.0;
    const Eigen::Vector2d hinge(room.door.x() + 0.55, room.door.y() + into * 0.1);
    const double angle = into * open_rad;
    const Eigen::Vector2d middle =
        hinge + 0.4 * Eigen::Vector2d(elementary::cos(angle), elementary::sin(angle));
    boxes.push_back(simulation::standing(middle, {0.8, 0.04, 2.0}, angle));
  }
  return boxes;
}

bool keeps_off(const simulation::Trajectory& way, const Eigen::Vector2d& at) {
  return std::none_of(way.poses().begin(), way.poses().end(), [&](const Pose2& pose) {
    return (Eigen::Vector2d(pose.x_m, pose.y_m) - at).norm() < 0.7;
  });
}

// People who stand in a room for a day.
void add_standing(const Building& building, const simulation::Trajectory& way, int count,
                  simulation::Random& random, std::vector<simulation::Trajectory>& people) {
  for (int i = 0; i < 1000 && count > 0; ++i) {
    const simulation::Room& room = building.rooms[random.bits() % building.rooms.size()];
    const double x = random.uniform(room.low.x(), room.high.x());
    const double y = random.uniform(room.low.y(), room.high.y());
    const double yaw = random.uniform(-std::numbers::pi, std::numbers::pi);
    if (building.clearance_m({x, y}, 0.05, 1.8) < 0.35 || !keeps_off(way, {x, y})) continue;
    people.emplace_back(1.0, std::vector<Pose2>{{x, y, yaw}});
    --count;
  }
}

std::vector<simulation::Trajectory> frozen(const std::vector<simulation::Trajectory>& people,
                                           double t_s) {
  std::vector<simulation::Trajectory> still;
  for (const auto& person : people) still.emplace_back(1.0, std::vector<Pose2>{person.at(t_s)});
  return still;
}

Cloud scan_rings(const simulation::World& world, const Pose2& pose, double t_s, int rings,
                 std::uint64_t seed) {
  simulation::SphereScanConfig config;
  config.rings = rings;
  config.rays = rings * 360;
  if (rings > 16) config.rings_to_deg = 22.5;
  const simulation::World now(world.building(), frozen(world.people(), t_s));
  return simulation::scan_sphere(now, pose, config, seed);
}

// What stands there on both days, and thin things among it; what did on the first.
struct Solid {
  simulation::BoxTree thin, both_days, before;
};

// A day: what stands there, who is about, and the robot's way.
class Day {
 public:
  Day(Building building, const Solid& solid, simulation::Trajectory way,
      const GhostDriveConfig& config, int number)
      : way_(std::move(way)),
        number_(number),
        seed_(static_cast<std::uint64_t>(config.seed * 100 + number)),
        solid_(solid),
        today_(building.solid),
        world_(building, people(building, config)),
        scanner_(world_, way_, {}, seed_),
        laser_(config.laser) {}

  void scan(std::vector<GhostScan>& scans) const {
    for (double t = kScanEvery_s; t < way_.duration_s(); t += kScanEvery_s) {
      GhostScan scan{cloud_at(t), way_.at(t), {}, {}, number_};
      for (std::size_t i = 0; i < scan.cloud.points.size(); ++i) look_along(i, scan);
      scans.push_back(std::move(scan));
    }
  }

 private:
  std::vector<simulation::Trajectory> people(const Building& building,
                                             const GhostDriveConfig& config) const {
    auto people = simulation::walk(building, way_, way_.duration_s(), {config.walking, 1.0}, seed_);
    simulation::Random random(seed_, 6);
    // On the last lap everybody who stood has left.
    if (number_ < 2) add_standing(building, way_, config.standing, random, people);
    return people;
  }

  Cloud cloud_at(double t_s) const {
    const auto seed = seed_ * 10'000 + static_cast<std::uint64_t>(t_s);
    if (laser_ == GhostLaser::kMirror)
      return simulation::scan_sweep(scanner_, way_, t_s, {}, seed_);
    return scan_rings(world_, way_.at(t_s), t_s, laser_ == GhostLaser::k16Rings ? 16 : 64, seed);
  }

  void look_along(std::size_t i, GhostScan& scan) const {
    const Eigen::Vector3d from = scan.truth * Eigen::Vector3d(scan.cloud.origin(i).cast<double>());
    const Eigen::Vector3d to = scan.truth * Eigen::Vector3d(scan.cloud.points[i].cast<double>());
    const double range_m = (to - from).norm();
    const Eigen::Vector3d along = (to - from) / range_m;
    const auto is_met_in = [&](const simulation::BoxTree& solid) {
      const auto hit = solid.range(from, along);
      return hit && range_m > *hit - kNearer_m;
    };
    scan.met.push_back(is_met_in(solid_.thin)        ? Met::kThin
                       : is_met_in(solid_.both_days) ? Met::kStatic
                       : is_met_in(today_)           ? Met::kMoved
                                                     : Met::kPerson);
    const auto before = solid_.before.range(from, along);
    if (number_ == 0 || !before || *before > range_m - kNearer_m) return;
    const Eigen::Vector3d missed = scan.truth.inverse() * Eigen::Vector3d(from + *before * along);
    scan.missed.push_back(missed.cast<float>());
  }

  const simulation::Trajectory way_;
  const int number_;
  const std::uint64_t seed_;
  const Solid& solid_;
  const simulation::BoxTree today_;
  const simulation::World world_;
  const simulation::MirrorScanner scanner_;
  const GhostLaser laser_;
};

bool is_in(const Building& building, const Box& box) {
  const std::vector<Box>& boxes = building.solid.boxes();
  return std::any_of(boxes.begin(), boxes.end(),
                     [&](const Box& other) { return same(box, other); });
}

std::vector<Box> in_both(const Building& a, const Building& b) {
  std::vector<Box> both;
  for (const Box& box : a.solid.boxes())
    if (is_in(b, box)) both.push_back(box);
  return both;
}

// The floor on three days: each time furniture and doors are elsewhere.
struct Days {
  explicit Days(int seed)
      : floor(floor_16_13(seed)),
        thin(thin_things(simulation::make_floor(floor.wing, floor.wings))),
        first(day(0, 90.0)),
        second(day(7, 65.0)),
        third(day(8, 40.0)),
        solid{simulation::BoxTree(thin), simulation::BoxTree(in_both(first, second)), first.solid} {
  }

  Building day(int changed, double doors_deg) const {
    TestFloorConfig config = floor;
    config.wing.changed = changed;
    const Building building = simulation::make_floor(config.wing, config.wings);
    return with(with(building, thin), doors(building, doors_deg * kRadPerDeg));
  }

  const TestFloorConfig floor;
  const std::vector<Box> thin;
  const Building first, second, third;
  const Solid solid;
};

// As a person draws it, who sees where things are to a few centimetres.
Eigen::AlignedBox3d drawn_about(const Box& box) {
  constexpr double kDrawn_m = 0.05;
  const auto [sine, cosine] = elementary::sine_cosine(box.yaw_rad);
  const double s = std::abs(sine), c = std::abs(cosine);
  const Eigen::Vector3d half(c * box.half_m.x() + s * box.half_m.y() + kDrawn_m,
                             s * box.half_m.x() + c * box.half_m.y() + kDrawn_m,
                             box.half_m.z() + kDrawn_m);
  return {box.centre_m - half, box.centre_m + half};
}

}  // namespace

simulation::Trajectory lap(const Building& building) {
  const std::vector<Eigen::Vector2d> path = simulation::plan_tour(building, {});
  std::vector<Pose2> poses;
  double from_m = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector2d way = path[i] - path[i - 1];
    const double length_m = way.norm();
    for (; from_m < length_m; from_m += kSpeed_mps * kPeriod_s) {
      const Eigen::Vector2d at = path[i - 1] + way * (from_m / length_m);
      poses.push_back({at.x(), at.y(), elementary::atan2(way.y(), way.x())});
    }
    from_m -= length_m;
  }
  return {kPeriod_s, std::move(poses)};
}

std::vector<GhostScan> ghost_drive(const GhostDriveConfig& config) {
  const Days days(config.seed);
  std::vector<GhostScan> scans;
  Day(days.first, days.solid, lap(days.first), config, 0).scan(scans);
  Day(days.second, days.solid, lap(days.second), config, 1).scan(scans);
  Day(days.second, days.solid, lap(days.second), config, 2).scan(scans);
  return scans;
}

std::vector<GhostScan> next_day(const GhostDriveConfig& config) {
  const Days days(config.seed);
  std::vector<GhostScan> scans;
  Day(days.third, days.solid, lap(days.third), config, 3).scan(scans);
  return scans;
}

std::vector<Eigen::AlignedBox3d> moved_away(const GhostDriveConfig& config) {
  const Days days(config.seed);
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Box& box : days.first.solid.boxes())
    if (!is_in(days.second, box)) boxes.push_back(drawn_about(box));
  return boxes;
}

}  // namespace voxlist::bench
