#include "tests/bench/drives/bad_scans.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "voxlist/geometry/pose.h"

namespace voxlist::bench {
namespace {

constexpr double kLid_m = 0.1, kPerson_m = 0.3, kPersonCovers = 0.9;
constexpr double kTilt_rad = 10.0 * std::numbers::pi / 180.0, kLift_m = 0.5;
// Nothing comes back from nearer than this.
constexpr double kNearest_m = 0.3;

// Applies `change(point, origin)` to each point.
template <class Change>
Cloud changed(Cloud scan, Change&& change) {
  for (std::size_t i = 0; i < scan.points.size(); ++i)
    scan.points[i] = change(scan.points[i], scan.origin(i));
  return scan;
}

Eigen::Vector3f on_the_ray(const Eigen::Vector3f& point, const Eigen::Vector3f& origin,
                           double range_m) {
  return origin + static_cast<float>(range_m) * (point - origin).normalized();
}

Eigen::Vector3f shortened(const Eigen::Vector3f& point, const Eigen::Vector3f& origin,
                          simulation::Random& random) {
  const double range = (point - origin).norm();
  return on_the_ray(point, origin, random.uniform(std::min(kNearest_m, range), range));
}

Eigen::Vector3f anywhere(simulation::Random& random) {
  const double x = random.uniform(-8.0, 8.0), y = random.uniform(-8.0, 8.0);
  return Eigen::Vector3d(x, y, random.uniform(0.0, 2.6)).cast<float>();
}

Cloud with_noise(const Cloud& scan, double share, simulation::Random& random) {
  return changed(scan, [&](const auto& point, const auto&) {
    return random.uniform(0.0, 1.0) < share ? anywhere(random) : point;
  });
}

Cloud first_points(Cloud scan, std::size_t count) {
  scan.points.resize(std::min(count, scan.points.size()));
  if (!scan.origins.empty()) scan.origins.resize(scan.points.size());
  return scan;
}

// The first nine tenths of all directions.
Cloud behind_a_person(const Cloud& scan) {
  return changed(scan, [](const Eigen::Vector3f& point, const Eigen::Vector3f& origin) {
    const Eigen::Vector3f way = point - origin;
    const double turn = std::atan2(way.y(), way.x()) / std::numbers::pi;  // -1 to 1
    return turn < 2.0 * kPersonCovers - 1.0 ? on_the_ray(point, origin, kPerson_m) : point;
  });
}

Cloud tilted(const Cloud& scan) {
  const Eigen::Matrix3f turn = rotation(kTilt_rad, Eigen::Vector3d::UnitY()).cast<float>();
  return changed(scan, [&](const Eigen::Vector3f& point, const Eigen::Vector3f& origin) {
    return Eigen::Vector3f(origin + turn * (point - origin));
  });
}

}  // namespace

const char* name(Bad bad) {
  constexpr const char* kNames[] = {"none",   "empty",  "one point",    "lid",
                                    "person", "tilted", "lifted",       "half noise",
                                    "noise",  "short",  "another place"};
  return kNames[static_cast<std::size_t>(bad)];
}

Cloud spoiled(const Cloud& scan, Bad bad, const Cloud& other, simulation::Random& random) {
  switch (bad) {
    case Bad::kNot:
      return scan;
    case Bad::kEmpty:
      return first_points(scan, 0);
    case Bad::kOnePoint:
      return first_points(scan, 1);
    case Bad::kLid:
      return changed(scan, [](const auto& p, const auto& o) { return on_the_ray(p, o, kLid_m); });
    case Bad::kPerson:
      return behind_a_person(scan);
    case Bad::kTilted:
      return tilted(scan);
    case Bad::kLifted:
      return changed(scan, [](const Eigen::Vector3f& p, const auto&) {
        return Eigen::Vector3f(p + Eigen::Vector3f(0.0f, 0.0f, static_cast<float>(kLift_m)));
      });
    case Bad::kHalfNoise:
      return with_noise(scan, 0.5, random);
    case Bad::kNoise:
      return with_noise(scan, 1.0, random);
    case Bad::kShort:
      return with_short_returns(scan, 1.0, random);
    case Bad::kOtherPlace:
      return other;
  }
  return scan;
}

Cloud with_short_returns(Cloud scan, double share, simulation::Random& random) {
  return changed(std::move(scan), [&](const Eigen::Vector3f& point, const Eigen::Vector3f& origin) {
    return random.uniform(0.0, 1.0) < share ? shortened(point, origin, random) : point;
  });
}

}  // namespace voxlist::bench
