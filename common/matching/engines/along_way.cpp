#include "voxlist/matching/engines/along_way.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace voxlist::matching {
namespace {

// Places on the line are looked at in steps of this (m): within the reach of an end of a ray.
constexpr double kStep_m = 0.05;
// Places so near to the pose (m) are the same to the ends of rays.
constexpr double kSame_m = 0.1;
// A place must explain rays better by so many standard deviations. Where no wheels slipped, places
// did by 3.6 at most on 1467 scans in corridors (bench_tracking, seeds 201 to 203): rings hit other
// spots. Where wheels slipped by half a step and doors were in sight, it was 4.0 and more.
constexpr double kNotByChance = 4.0;
// Rays that go through things must say so, too, by so many of them. Rings that hit the very spots
// of an earlier scan explain more of a bare wall, but nothing is gone through there, wherever it
// is.
constexpr double kShape = 3.0;

// How many standard deviations it is from chance that more things became better than worse.
double sigmas(int better, int worse) { return (better - worse) / std::sqrt(better + worse + 1.0); }

// What becomes of rays from one place to another: so many that spoke against the first do not
// against the second, and the other way round; so many of them because of what they go through.
struct Change {
  int better = 0, worse = 0, better_through = 0, worse_through = 0;

  double sigmas_better() const {
    const bool shape = sigmas(better_through, worse_through) >= kShape;
    return shape ? sigmas(better, worse) : 0.0;
  }
};

struct JudgedRay {
  ScanRay ray;
  Evidence here;
};

class Line {
 public:
  Line(const EvidenceMap& map, const SurfelMap& surfels, std::span<const ScanRay> rays,
       const Pose2& pose, const Eigen::Vector2d& way)
      : map_(map), surfels_(surfels), pose_(pose), way_(way) {
    for (const ScanRay& ray : rays) rays_.push_back({ray, judged(ray, pose)});
    against_ = std::partition(
                   rays_.begin(), rays_.end(),
                   [](const JudgedRay& ray) { return ray.here.misses + ray.here.violations > 0; }) -
               rays_.begin();
  }

  Pose2 at(double offset_m) const {
    return {pose_.x_m + offset_m * way_.x(), pose_.y_m + offset_m * way_.y(), pose_.yaw_rad};
  }

  // How much better a place is, in standard deviations; 0 where it can be so by chance alone.
  double better_by(double offset_m) const {
    Change change;
    const Pose2 there = at(offset_m);
    const auto all = std::span(rays_);
    add(all.first(static_cast<std::size_t>(against_)), there, change);
    if (sigmas(change.better, 0) < kNotByChance) return 0.0;
    add(all.subspan(static_cast<std::size_t>(against_)), there, change);
    return change.sigmas_better();
  }

 private:
  Evidence judged(const ScanRay& ray, const Pose2& pose) const {
    return map_.on_surfaces(pose, {&ray, 1}, surfels_);
  }

  void add(std::span<const JudgedRay> rays, const Pose2& there, Change& change) const {
    for (const JudgedRay& ray : rays) {
      const Evidence now = judged(ray.ray, there), &here = ray.here;
      const int through = here.violations - now.violations;
      change.better += here.misses * now.hits + std::max(0, through);
      change.worse += here.hits * now.misses + std::max(0, -through);
      change.better_through += std::max(0, through);
      change.worse_through += std::max(0, -through);
    }
  }

  const EvidenceMap& map_;
  const SurfelMap& surfels_;
  const Pose2 pose_;
  const Eigen::Vector2d way_;  // of 1 m
  std::vector<JudgedRay> rays_;
  std::ptrdiff_t against_ = 0;  // so many of them, the first ones, speak against the pose
};

struct Offset {
  double offset_m, sigmas;
};

// The middle of the places that are about as good as the best, and their spread.
PlaceOnLine middle(const Line& line, const std::vector<Offset>& offsets, double best) {
  double n = 0.0, sum = 0.0, squares = 0.0;
  for (const Offset& o : offsets) {
    if (o.sigmas < best - 1.0) continue;
    n += 1.0;
    sum += o.offset_m;
    squares += o.offset_m * o.offset_m;
  }
  const double mean = sum / n;
  return {line.at(mean), std::sqrt(std::max(0.0, squares / n - mean * mean) + kReach_m * kReach_m)};
}

}  // namespace

std::optional<PlaceOnLine> better_along(const EvidenceMap& map, const SurfelMap& surfels,
                                        std::span<const ScanRay> rays, const Pose2& pose,
                                        const Evidence& evidence, const Eigen::Vector2d& reach) {
  const double reach_m = reach.norm();
  if (reach_m < kSame_m || sigmas(evidence.misses + evidence.violations, 0) < kNotByChance)
    return std::nullopt;
  const Line line(map, surfels, rays, pose, reach / reach_m);
  std::vector<Offset> offsets;
  const int steps = static_cast<int>(std::ceil(reach_m / kStep_m));
  for (int i = -steps; i <= steps; ++i)
    offsets.push_back({i * kStep_m, line.better_by(i * kStep_m)});
  const Offset best = *std::max_element(offsets.begin(), offsets.end(),
                                        [](auto& a, auto& b) { return a.sigmas < b.sigmas; });
  if (best.sigmas < kNotByChance || std::abs(best.offset_m) <= kSame_m) return std::nullopt;
  return middle(line, offsets, best.sigmas);
}

}  // namespace voxlist::matching
