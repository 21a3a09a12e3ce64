#include "voxlist/matching/scan/floor.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "voxlist/geometry/angle.h"

namespace voxlist::matching {
namespace {

// Squares of the ground, and how many of them there are to each side of base: 10 m. Farther floors
// are hit by few rays, and are more often other floors.
constexpr double kSquare_m = 0.5;
constexpr int kSquares = 20;

// A square's lowest point lies on the floor when it is this near (m): unevenness, noise, dirt. The
// first plane is asked for more, or it leans on the feet of walls.
constexpr double kOnFloor_m = 0.08, kFirst_m = 0.04;
// A square whose lowest point has others so far (m) above it holds a wall or a thing that stands
// there: it may hide the floor, and is no floor of its own.
constexpr double kStands_m = 0.1, kStandsBelow_m = 0.6;
// Where the fit looks for the floor's own points (m), and the distance from the plane at which they
// count a quarter: a scanner's noise of 0.02 m, and some.
constexpr double kBand_m = 0.06, kScale_m = 0.03;
// The first plane is off by no more than this (m) where there is floor.
constexpr double kNear_m = 0.2;
// Cosine of the steepest slope that is a floor: 30 deg.
constexpr double kSteepest = 0.866;
// Fewest squares that tell a floor, and the share of all squares that must agree.
constexpr std::size_t kFewest = 12;
constexpr double kLeastAgreement = 0.5;
// Planes that are tried, on so many squares at most. Where half of the squares are on the floor, an
// eighth of all triples are, and a third of these are far enough apart: all miss with a probability
// of 1 in 300,000.
constexpr int kTrials = 300;
constexpr std::size_t kTriedOn = 400;
// Squares that span less than this area (m^2) between them tell no slope.
constexpr double kLeastSpan_m2 = 2.0;
// A floor whose slopes are known worse (rad) is not told.
constexpr double kWorstSigma_rad = 0.005;
constexpr int kFits = 4;

// z = height + slope * (x, y).
class Plane {
 public:
  Plane() = default;
  explicit Plane(const Eigen::Vector3d& height_and_slope)
      : plane_(height_and_slope),
        cosine_(1.0 / std::sqrt(1.0 + height_and_slope.tail<2>().squaredNorm())) {}

  double at(double x, double y) const { return plane_(0) + plane_(1) * x + plane_(2) * y; }
  // How far (m) a point is above the plane.
  double above(const Eigen::Vector3d& p) const { return (p.z() - at(p.x(), p.y())) * cosine_; }
  bool is_steep() const { return cosine_ < kSteepest; }
  Eigen::Vector3d up() const { return cosine_ * Eigen::Vector3d(-plane_(1), -plane_(2), 1.0); }

 private:
  Eigen::Vector3d plane_ = Eigen::Vector3d::Zero();
  double cosine_ = 1.0;  // of the angle that it leans by
};

// The ground in squares.
template <class Value>
class Squares {
 public:
  Value* at(const Eigen::Vector3f& p) {
    const int x = number(p.x()), y = number(p.y());
    if (x < 0 || y < 0) return nullptr;
    return &values_[static_cast<std::size_t>(2 * kSquares * y + x)];
  }
  const auto& values() const { return values_; }

 private:
  // std::floor without a call; -1 beyond the ground, and for what is no number.
  static int number(float value_m) {
    const double squares = static_cast<double>(value_m) / kSquare_m;
    if (!(squares >= -kSquares && squares < kSquares)) return -1;
    const auto whole = static_cast<int>(squares);
    return whole - (squares < whole ? 1 : 0) + kSquares;
  }

  std::array<Value, std::size_t{4} * kSquares * kSquares> values_{};
};

std::vector<Eigen::Vector3d> lowest_points(const Cloud& cloud) {
  Squares<const Eigen::Vector3f*> lowest;
  for (const Eigen::Vector3f& p : cloud.points) {
    const Eigen::Vector3f** square = lowest.at(p);
    if (square && (!*square || p.z() < (*square)->z())) *square = &p;
  }
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f* p : lowest.values())
    if (p) points.push_back(p->cast<double>());
  return points;
}

// Numbers that look random, the same on every machine.
class Lots {
 public:
  std::size_t below(std::size_t n) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::size_t>((state_ >> 33) % n);
  }

 private:
  std::uint64_t state_ = 1;
};

std::optional<Plane> plane_through(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                   const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  if (std::abs(normal.z()) < kLeastSpan_m2) return std::nullopt;
  const Eigen::Vector2d slope = -normal.head<2>() / normal.z();
  const Plane plane({a.z() - slope.dot(a.head<2>()), slope.x(), slope.y()});
  return plane.is_steep() ? std::nullopt : std::optional(plane);
}

// Points that planes are tried on, coordinate by coordinate.
struct TriedPoints {
  std::vector<double> x, y, z;

  TriedPoints(const std::vector<Eigen::Vector3d>& points, std::size_t step) {
    for (std::size_t i = 0; i < points.size(); i += step) {
      x.push_back(points[i].x());
      y.push_back(points[i].y());
      z.push_back(points[i].z());
    }
  }
  std::size_t size() const { return x.size(); }
};

// Squares on a plane less those below it, where there is no floor; no more than `most` where the
// squares that are left cannot make it more.
int agreement(const Plane& plane, const TriedPoints& points, int most) {
  constexpr std::size_t kAtOnce = 32;
  int agree = 0;
  for (std::size_t i = 0; i < points.size();) {
    if (agree + static_cast<int>(points.size() - i) <= most) return agree;
    for (const std::size_t end = std::min(points.size(), i + kAtOnce); i < end; ++i) {
      const double above_m = plane.above({points.x[i], points.y[i], points.z[i]});
      agree += std::abs(above_m) < kFirst_m;
      agree -= above_m < -2.0 * kFirst_m;
    }
  }
  return agree;
}

Plane most_agreed(const std::vector<Eigen::Vector3d>& lowest) {
  Plane best;
  int most = 0;
  Lots lots;
  const auto any = [&] { return lowest[lots.below(lowest.size())]; };
  const TriedPoints tried(lowest, 1 + lowest.size() / kTriedOn);
  for (int i = 0; i < kTrials; ++i) {
    const Eigen::Vector3d a = any(), b = any(), c = any();
    const auto plane = plane_through(a, b, c);
    if (!plane) continue;
    const int agree = agreement(*plane, tried, most);
    if (agree > most) most = agree, best = *plane;
  }
  return best;
}

// What a square shows beside a plane.
struct Ground {
  double lowest_m = std::numeric_limits<double>::infinity();
  bool stands = false;
  int low_points = 0;  // about as low as the lowest

  bool is_on() const { return std::abs(lowest_m) < kOnFloor_m; }
  // A lowest surface that is not on the plane; one point is none.
  bool disagrees() const { return !is_on() && low_points > 1 && (lowest_m < 0.0 || !stands); }
};

// A point of a square, and how far it is above the plane.
struct Above {
  Ground* square;
  const Eigen::Vector3f* point;
  double above_m;
};

std::vector<Above> points_above(const Plane& plane, const Cloud& cloud, Squares<Ground>& squares) {
  std::vector<Above> points;
  points.reserve(cloud.points.size());
  for (const Eigen::Vector3f& point : cloud.points)
    if (Ground* square = squares.at(point))
      points.push_back({square, &point, plane.above(point.cast<double>())});
  for (const Above& p : points) p.square->lowest_m = std::min(p.square->lowest_m, p.above_m);
  for (const Above& p : points) {
    const double over_m = p.above_m - p.square->lowest_m;
    if (over_m > kStands_m && over_m < kStandsBelow_m) p.square->stands = true;
    if (over_m <= kStands_m) ++p.square->low_points;
  }
  return points;
}

double share_that_agrees(const Squares<Ground>& squares) {
  const auto& all = squares.values();
  const auto on = std::ranges::count_if(all, &Ground::is_on),
             off = std::ranges::count_if(all, &Ground::disagrees);
  return static_cast<double>(on) / static_cast<double>(std::max<std::ptrdiff_t>(1, on + off));
}

// Mean of a square's points on the floor, so that near squares, which are full of points, count no
// more than others.
struct OnFloor {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weight = 0.0;

  void add(const Eigen::Vector3d& p, double w) {
    sum += w * p;
    weight += w;
  }
  Eigen::Vector3d mean() const { return sum / weight; }
};

std::vector<Eigen::Vector3d> means_on(const Plane& plane,
                                      const std::vector<Eigen::Vector3d>& points) {
  Squares<OnFloor> squares;
  for (const Eigen::Vector3d& p : points) {
    const double off = plane.above(p), falloff = kScale_m * kScale_m + off * off;
    if (std::abs(off) < kBand_m) squares.at(p.cast<float>())->add(p, 1.0 / (falloff * falloff));
  }
  std::vector<Eigen::Vector3d> means;
  for (const OnFloor& square : squares.values())
    if (square.weight > 0.0) means.push_back(square.mean());
  return means;
}

// Points about on the plane, of squares where nothing stands on it.
std::vector<Eigen::Vector3d> on_floor(const std::vector<Above>& points) {
  std::vector<Eigen::Vector3d> near;
  for (const Above& p : points)
    if (p.square->is_on() && !p.square->stands && p.above_m < kNear_m)
      near.push_back(p.point->cast<double>());
  return near;
}

// Least squares through the squares' means.
struct Fit {
  Plane plane;
  double sigma_rad = 0.0;

  explicit Fit(const std::vector<Eigen::Vector3d>& means) {
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Eigen::Vector3d products = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : means) {
      const Eigen::Vector3d row(1.0, p.x(), p.y());
      squares += row * row.transpose();
      products += p.z() * row;
    }
    const Eigen::LDLT<Eigen::Matrix3d> solver(squares);
    plane = Plane(solver.solve(products));
    double off2 = kScale_m * kScale_m;
    for (const Eigen::Vector3d& p : means) off2 += plane.above(p) * plane.above(p);
    const Eigen::Matrix3d inverse = solver.solve(Eigen::Matrix3d::Identity());
    const double slopes2 = std::max(inverse(1, 1), inverse(2, 2));
    sigma_rad = std::sqrt(off2 / static_cast<double>(means.size()) * slopes2);
  }
};

// Where the rays start, in the mean.
Eigen::Vector3d start_of_rays(const Cloud& cloud) {
  if (cloud.origins.empty()) return Eigen::Vector3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& origin : cloud.origins) sum += origin.cast<double>();
  return sum / static_cast<double>(cloud.origins.size());
}

// T_level_base of a plane in base.
Tilt levelling(const Plane& plane) {
  // Rolled, then pitched, the normal must become the z axis: it is the rotation's bottom row.
  Pose3 T = Pose3::Identity();
  T.linear().row(2) = plane.up().transpose();
  T.translation().z() = plane.above(Eigen::Vector3d::Zero());
  return tilt_of(T);
}

// From so much on (rad, m) a floor is off: floors of halls lean by a degree or two, and base is on
// the floor.
constexpr double kTilted_rad = 2.0 * kRadPerDeg, kHigh_m = 0.1;

}  // namespace

std::string what_is_off(const Floor& floor) {
  const double height_m = floor.height_m();
  std::string text;
  if (floor.lean_rad() >= kTilted_rad)
    text = fmt::format("tilted by {:.1f} deg", floor.lean_rad() / kRadPerDeg);
  if (std::abs(height_m) >= kHigh_m)
    text += fmt::format("{}{:.2f} m {}", text.empty() ? "" : ", ", std::abs(height_m),
                        height_m < 0.0 ? "low" : "high");
  return text.empty() ? text : "floor " + text + ": is the mount set?";
}

std::optional<Floor> find_floor(const Cloud& cloud) {
  const std::vector<Eigen::Vector3d> lowest = lowest_points(cloud);
  if (lowest.size() < kFewest) return std::nullopt;
  Plane plane = most_agreed(lowest);
  Squares<Ground> squares;
  const std::vector<Eigen::Vector3d> near = on_floor(points_above(plane, cloud, squares));
  Floor floor;
  for (int i = 0; i < kFits; ++i) {
    const std::vector<Eigen::Vector3d> means = means_on(plane, near);
    if (means.size() < kFewest) return std::nullopt;
    const Fit fit(means);
    plane = fit.plane;
    floor.sigma_rad = fit.sigma_rad;
  }
  floor.agreement = share_that_agrees(squares);
  floor.level = levelling(plane);
  const bool is_told = floor.agreement > kLeastAgreement && !plane.is_steep() &&
                       floor.sigma_rad < kWorstSigma_rad && plane.above(start_of_rays(cloud)) > 0.0;
  return is_told ? std::optional(floor) : std::nullopt;
}

}  // namespace voxlist::matching
