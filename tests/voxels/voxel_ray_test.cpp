#include "voxlist/voxels/voxel_ray.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

namespace voxlist {
namespace {

constexpr double kResolution_m = 0.08;
constexpr std::uint32_t kSeed = 20'231'104;

using Point = Eigen::Vector3d;

std::vector<Voxel> way(const Point& from, const Point& to, double resolution_m = kResolution_m) {
  std::vector<Voxel> voxels;
  visit_ray(from, to, resolution_m, [&](const Voxel& v) {
    voxels.push_back(v);
    return true;
  });
  return voxels;
}

int faces_between(const Voxel& a, const Voxel& b) {
  return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z);
}

// From end to end by faces, and no way round.
void expect_straight(const Point& from, const Point& to, const std::vector<Voxel>& voxels,
                     double resolution_m = kResolution_m) {
  ASSERT_FALSE(voxels.empty());
  EXPECT_EQ(voxels.front(), voxel_at(from, resolution_m));
  EXPECT_EQ(voxels.back(), voxel_at(to, resolution_m));
  EXPECT_EQ(std::ssize(voxels), 1 + faces_between(voxels.front(), voxels.back()));
  for (std::size_t i = 1; i < voxels.size(); ++i)
    ASSERT_EQ(faces_between(voxels[i - 1], voxels[i]), 1) << "step " << i;
}

// Whether the way from a to b comes within `margin_m` of the voxel: by cutting it off at the
// voxel's faces, one axis after the other.
bool touches(const Point& a, const Point& b, const Voxel& v, double margin_m) {
  const Point low = Point(v.x, v.y, v.z) * kResolution_m - Point::Constant(margin_m);
  const Point high = low + Point::Constant(kResolution_m + 2 * margin_m);
  double enter = 0.0, leave = 1.0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double step = b[i] - a[i];
    if (step == 0.0) {
      if (a[i] < low[i] || a[i] > high[i]) return false;
      continue;
    }
    const double t1 = (low[i] - a[i]) / step, t2 = (high[i] - a[i]) / step;
    enter = std::max(enter, std::min(t1, t2));
    leave = std::min(leave, std::max(t1, t2));
  }
  return enter <= leave;
}

// Whether a point is so near a face that rounding may put it on either side.
bool on_a_face(const Point& p) {
  return ((p / kResolution_m).array() - (p / kResolution_m).array().round()).abs().minCoeff() <
         1e-9;
}

class RandomRay {
 public:
  explicit RandomRay(double extent_m) : coordinate_(-extent_m, extent_m) {}
  Point point() { return {coordinate_(random_), coordinate_(random_), coordinate_(random_)}; }

 private:
  std::mt19937 random_{kSeed};
  std::uniform_real_distribution<double> coordinate_;
};

TEST(VoxelRay, GoesFromEndToEndByFaces) {
  SCOPED_TRACE(kSeed);
  RandomRay random(30.0);
  for (int i = 0; i < 5000; ++i) {
    const Point from = random.point(), to = random.point();
    expect_straight(from, to, way(from, to));
  }
}

TEST(VoxelRay, VisitsWhatPointsAlongItLieInAndNothingElse) {
  SCOPED_TRACE(kSeed);
  RandomRay random(2.0);
  for (int i = 0; i < 300; ++i) {
    const Point from = random.point(), to = random.point();
    const auto voxels = way(from, to);
    const std::set<Voxel> visited(voxels.begin(), voxels.end());
    EXPECT_EQ(visited.size(), voxels.size()) << "ray " << i << " visits a voxel twice";
    for (int s = 0; s <= 20'000; ++s) {
      const Point p = from + (to - from) * s / 20'000;
      ASSERT_TRUE(on_a_face(p) || visited.contains(voxel_at(p, kResolution_m))) << "ray " << i;
    }
    for (const Voxel& v : voxels) ASSERT_TRUE(touches(from, to, v, 1e-9)) << "ray " << i;
  }
}

TEST(VoxelRay, GoesStraightAlongAnAxisEitherWay) {
  const Point low(-0.20, 0.05, -0.01), high(0.13, 0.05, -0.01);
  const std::vector<Voxel> up{{-3, 0, -1}, {-2, 0, -1}, {-1, 0, -1}, {0, 0, -1}, {1, 0, -1}};
  EXPECT_EQ(way(low, high), up);
  EXPECT_EQ(way(high, low), std::vector<Voxel>(up.rbegin(), up.rend()));
}

TEST(VoxelRay, GoesDownZAsAlongTheOthers) {
  EXPECT_EQ(way({0.01, 0.01, 0.10}, {0.01, 0.01, -0.10}),
            (std::vector<Voxel>{{0, 0, 1}, {0, 0, 0}, {0, 0, -1}, {0, 0, -2}}));
}

TEST(VoxelRay, TakesTheNearerFaceFirst) {
  EXPECT_EQ(way({0.01, 0.03, 0.04}, {0.11, 0.15, 0.04}),
            (std::vector<Voxel>{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
}

TEST(VoxelRay, StaysConnectedThroughCorners) {
  for (const int sign : {-1, 1}) {
    const Point middle(0.04, 0.04, 0.04), far = middle + Point(0.8, sign * 0.8, -0.8);
    expect_straight(middle, far, way(middle, far));
    expect_straight(far, middle, way(far, middle));
  }
}

TEST(VoxelRay, EndsExactlyWhereItsEndsLieOnFaces) {
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  const auto on_lattice = [&] { return (static_cast<int>(random() % 41) - 20) * kResolution_m; };
  for (int i = 0; i < 5000; ++i) {
    const Point from(on_lattice(), on_lattice(), on_lattice());
    const Point to(on_lattice(), on_lattice(), on_lattice());
    expect_straight(from, to, way(from, to));
  }
}

TEST(VoxelRay, CrossesAFaceAtACrawl) {
  const Point from(0.08 - 1e-15, 0.01, 0.01), to(0.08 + 1e-15, 5.01, -5.01);
  expect_straight(from, to, way(from, to));
}

TEST(VoxelRay, ReachesFromEndToEndOfTheLattice) {
  const double end_m = 0.999 * kVoxelLimit;
  const Point from(-end_m, end_m, 0.3), to(end_m, 0.7 * end_m, -0.3);
  std::int64_t visits = 0;
  Voxel last;
  visit_ray(from, to, 1.0, [&](const Voxel& v) {
    ++visits;
    last = v;
    return true;
  });
  EXPECT_EQ(last, voxel_at(to, 1.0));
  EXPECT_EQ(visits, 1 + faces_between(voxel_at(from, 1.0), last));
}

TEST(VoxelRay, WithinOneVoxelVisitsItOnce) {
  EXPECT_EQ(way({0.01, 0.01, 0.01}, {0.07, 0.03, 0.02}), (std::vector<Voxel>{{0, 0, 0}}));
  EXPECT_EQ(way({-0.01, 0.01, 0.01}, {-0.01, 0.01, 0.01}), (std::vector<Voxel>{{-1, 0, 0}}));
}

TEST(VoxelRay, StopsWhenItIsTold) {
  std::vector<Voxel> voxels;
  visit_ray({0.01, 0.01, 0.01}, {8.0, 0.01, 0.01}, kResolution_m, [&](const Voxel& v) {
    voxels.push_back(v);
    return v.x < 2;
  });
  EXPECT_EQ(voxels, (std::vector<Voxel>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
}

}  // namespace
}  // namespace voxlist
