#include "voxlist/planning/rays/line_drops.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace voxlist::planning {
namespace {

// Beams of one line are within 3.5 deg of each other (the sine of it): of 1 deg, two may be lost.
constexpr float kNeighbour_sine = 0.061F;

// Floor beside a gap is so many beams, and beside an edge: the slope of few is mostly noise.
constexpr std::size_t kBesideGap = 5, kBesideEdge = 8;

// A gap holds so many beams that are below the floor, and is no wider than this (m): farther apart,
// two pieces of floor need not be one.
constexpr std::size_t kBeams = 3;
constexpr float kWidest_m = 1.5F;

// Below a line's floor is what is deeper than this (m), seven times the noise of a height at 2 m
// from 0.8 m up, and than so many standard deviations of the floor beside it. Floor that is off its
// line by more than kStraight_m is none.
constexpr float kDeep_m = 0.025F, kDeviations = 4.0F, kStraight_m = 0.02F;

// An edge is a step of this or more (m). Floor is no steeper along a line than this, above and
// below the step.
constexpr float kStep_m = 0.06F, kSteepest = 0.2F;

// Beams at a gap's or edge's rim fall on both sides of it: so many are not asked.
constexpr std::size_t kRim = 2;

using Points = std::span<const Eigen::Vector3f>;

// Heights over the way along a line: z = height_m + slope * along_m.
struct Profile {
  float height_m, slope, deviation_m;

  float below_m(const Eigen::Vector2f& at) const { return height_m + slope * at.x() - at.y(); }
};

// A point of a line: how far along it is from where the floor beside it begins, and its height (m).
using Flat = Eigen::Vector2f;

// The points from one of them on, until they are farther along than the floor before and behind a
// gap may be. The first `beside` of them give the way.
std::vector<Flat> along(Points points, std::size_t beside) {
  const Eigen::Vector2f start = points.front().head<2>();
  const Eigen::Vector2f way = (points[beside - 1].head<2>() - start).normalized();
  std::vector<Flat> flat;
  for (const Eigen::Vector3f& point : points) {
    flat.emplace_back((point.head<2>() - start).dot(way), point.z());
    if (flat.back().x() > 2.0F * kWidest_m) break;
  }
  return flat;
}

// The straight floor that two runs of points make together; nothing where they make none.
std::optional<Profile> fit(std::span<const Flat> a, std::span<const Flat> b) {
  const auto n = static_cast<float>(a.size() + b.size());
  Eigen::Vector2f mean = Eigen::Vector2f::Zero();
  for (const auto part : {a, b})
    for (const Flat& p : part) mean += p / n;
  float xx = 0.0F, xz = 0.0F, squares = 0.0F, most_m = 0.0F;
  for (const auto part : {a, b})
    for (const Flat& p : part) {
      xx += (p.x() - mean.x()) * (p.x() - mean.x());
      xz += (p.x() - mean.x()) * (p.y() - mean.y());
    }
  if (xx <= 0.0F) return std::nullopt;
  const float slope = xz / xx;
  Profile profile{mean.y() - slope * mean.x(), slope, 0.0F};
  for (const auto part : {a, b})
    for (const Flat& p : part) {
      squares += profile.below_m(p) * profile.below_m(p);
      most_m = std::max(most_m, std::abs(profile.below_m(p)));
    }
  profile.deviation_m = std::sqrt(squares / (n - 2.0F));
  if (most_m > kStraight_m || std::abs(slope) > kSteepest) return std::nullopt;
  return profile;
}

float deep_m(const Profile& floor) { return std::max(kDeep_m, kDeviations * floor.deviation_m); }

// One line, point by point.
class Line {
 public:
  Line(Points points, std::span<LineDrop> drops) : points_(points), drops_(drops) {}

  void find_gaps() const {
    for (std::size_t first = kBesideGap; first + kBeams + kBesideGap <= points_.size(); ++first)
      if (begins_at(first)) find_gap(first);
  }

  // `back`: the line is walked the other way.
  void find_edges(bool back) const {
    std::vector<Eigen::Vector3f> walked(points_.begin(), points_.end());
    if (back) std::ranges::reverse(walked);
    for (std::size_t first = kBesideEdge; first + kBesideEdge <= walked.size(); ++first)
      find_edge(walked, first, back);
  }

 private:
  // Cheap: most of a line is straight.
  bool begins_at(std::size_t first) const {
    const float before_m = points_[first - 1].z();
    return before_m - points_[first].z() > kDeep_m / 2.0F ||
           before_m - points_[first + 1].z() > kDeep_m / 2.0F;
  }

  void find_gap(std::size_t first) const {
    const auto flat = along(points_.subspan(first - kBesideGap), kBesideGap);
    const auto all = std::span(flat), before = all.first(kBesideGap);
    if (!fit(before, {})) return;
    for (std::size_t end = kBesideGap + kBeams; end + kBesideGap <= flat.size(); ++end) {
      if (flat[end].x() - before.back().x() > kWidest_m) return;
      const auto floor = fit(before, all.subspan(end, kBesideGap));
      if (!floor || !is_gap(all.subspan(kBesideGap, end - kBesideGap), *floor)) continue;
      for (std::size_t i = kBesideGap; i < end; ++i) {
        const float below_m = floor->below_m(flat[i]);
        if (below_m > deep_m(*floor)) drops_[first - kBesideGap + i] = {below_m, true};
      }
      return;
    }
  }

  static bool is_gap(std::span<const Flat> inside, const Profile& floor) {
    const auto below = std::ranges::count_if(
        inside, [&](const Flat& p) { return floor.below_m(p) > deep_m(floor); });
    return static_cast<std::size_t>(below) >=
           std::max(kBeams, inside.size() - std::min(kRim, inside.size()));
  }

  void find_edge(Points walked, std::size_t first, bool back) const {
    if (walked[first - 1].z() - walked[first].z() < kStep_m / 2.0F) return;
    const auto flat = along(walked.subspan(first - kBesideEdge), kBesideEdge);
    const auto all = std::span(flat);
    const auto above = fit(all.first(kBesideEdge), {});
    if (!above) return;
    for (std::size_t skipped = 0; skipped < kRim; ++skipped) {
      if (2 * kBesideEdge + skipped > flat.size()) return;
      const auto beyond = all.subspan(kBesideEdge + skipped, kBesideEdge);
      if (!fit(beyond, {}) || above->below_m(beyond.front()) < kStep_m ||
          above->below_m(beyond.back()) < kStep_m)
        continue;
      for (std::size_t i = 0; i < kBesideEdge; ++i) {
        const std::size_t at = first + skipped + i;
        LineDrop& drop = drops_[back ? walked.size() - 1 - at : at];
        if (drop.below_m == 0.0F) drop = {above->below_m(beyond[i]), false};
      }
      return;
    }
  }

  Points points_;
  std::span<LineDrop> drops_;
};

bool follows(const Cloud& cloud, std::size_t i) {
  const Eigen::Vector3f a = cloud.points[i - 1] - cloud.origin(i - 1),
                        b = cloud.points[i] - cloud.origin(i);
  return a.dot(b) > 0.0F && a.cross(b).norm() < kNeighbour_sine * a.norm() * b.norm();
}

}  // namespace

std::vector<LineDrop> find_line_drops(const Cloud& cloud_base) {
  const std::size_t size = cloud_base.points.size();
  std::vector<LineDrop> drops(size);
  for (std::size_t from = 0; from < size;) {
    std::size_t to = from + 1;
    while (to < size && follows(cloud_base, to)) ++to;
    const Line line(Points(cloud_base.points).subspan(from, to - from),
                    std::span(drops).subspan(from, to - from));
    line.find_gaps();
    line.find_edges(false);
    line.find_edges(true);
    from = to;
  }
  return drops;
}

}  // namespace voxlist::planning
