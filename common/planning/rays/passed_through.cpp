#include "voxlist/planning/rays/passed_through.h"

#include <algorithm>
#include <cmath>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"

namespace voxlist::planning {
namespace {

// A ray refutes a point that it passes this close to (m). Thin: what ODOMETRY and a range are off
// by at least, so that a beam beside a chair's leg says nothing against it. Wide: less than what
// the width of such a thing is.
constexpr float kThin_m = 0.01F, kWide_m = 0.07F;

// It must go on for so long behind the point (m): three times the noise of the ranges of both.
constexpr float kBeyond_m = 0.15F;

// Rays that are needed: one alone may be a false echo itself; past a wide thing's edge some go.
constexpr int kThinPasses = 2, kWidePasses = 3;

// Rays by bearing, so that a point is held against those of its own bearing alone.
constexpr int kBins = 360;

int bin_of(const Eigen::Vector3f& p) {
  const double turns = elementary::atan2(p.y(), p.x()) / kTurn_rad + 0.5;
  return std::clamp(static_cast<int>(turns * kBins), 0, kBins - 1);
}

bool passes(const Ray& ray, const Ray& old) {
  const Eigen::Vector3f way = ray.point - ray.origin, to = old.point - ray.origin;
  const float length = way.norm();
  const float along = to.dot(way) / length;
  if (along <= 0.0F || along + kBeyond_m > length) return false;
  const float reach = old.is_wide ? kWide_m : kThin_m;
  return to.squaredNorm() - along * along < reach * reach;
}

}  // namespace

void count_passes(std::vector<Ray>& old, const std::vector<Ray>& news) {
  std::vector<std::vector<const Ray*>> bins(kBins);
  for (const Ray& ray : news) bins[static_cast<std::size_t>(bin_of(ray.point))].push_back(&ray);
  for (Ray& ray : old) {
    const int bin = bin_of(ray.point);
    // Within a metre a hand's breadth is several bearings wide.
    const int beside = ray.point.head<2>().squaredNorm() < 1.0F ? 6 : 2;
    for (int near = bin - beside; near <= bin + beside; ++near)
      for (const Ray* later : bins[static_cast<std::size_t>((near + kBins) % kBins)])
        if (passes(*later, ray)) ++ray.passed;
  }
}

bool is_refuted(const Ray& ray) { return ray.passed >= (ray.is_wide ? kWidePasses : kThinPasses); }

}  // namespace voxlist::planning
