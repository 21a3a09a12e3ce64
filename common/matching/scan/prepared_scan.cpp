#include "voxlist/matching/scan/prepared_scan.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "voxlist/matching/scan/flat_surfaces.h"
#include "voxlist/matching/scan/lonely_points.h"
#include "voxlist/voxels/fast_cell.h"
#include "voxlist/voxels/numbering.h"

namespace voxlist::matching {
namespace {

// Levels of cubes: 0.05, 0.1 and 0.2 m. Near things and small ones are told by the finest cubes. A
// refinement needs a few points on each surfel of 0.3 m. Rays in cubes of 0.2 m weigh surfaces by
// their area out to 8 m, where a mirror scanner's points are 0.2 m apart.
constexpr std::size_t kNearLevel = 0, kRefineLevel = 1, kEvenLevel = 2;

// Most rays that weigh a pose when a robot is lost; 0.8 ms a pose (floor_16_13). The coefficients
// of confidence.cpp were fitted with these, and with the two levels above: fit again after a
// change.
constexpr std::size_t kMostRays = 3000;

// Most rays that weigh one of many candidates, or a tracked pose: 0.2 ms a pose (floor_16_13). Time
// grows with it; other numbers were not compared.
constexpr std::size_t kFewRays = 600;

// Most points that are counted in a window and refine a first time. The lattice of 0.08 m is too
// coarse for more to tell poses apart; time grows with them.
constexpr std::size_t kFewPoints = 400;

// A layer of points keeps at most this multiple of the median layer's: floors that are not quite
// flat would else outvote walls. Chosen by judgement, as is the next.
constexpr double kMostOfUsual = 1.5;

// With a smaller share of the scan outside of flat surfaces, all points take part: fewer tell
// nothing.
constexpr double kLeastUpright = 0.05;

// A search counts the points of the widest cubes of which at least so many hold one, up to 0.4 m
// (kFinestCube_m doubled three times). Chosen by judgement: fewer points leave more wrong poses
// that overlap as much, wider cubes are wider than furniture.
constexpr std::size_t kEnoughToSearch = 300;
constexpr int kMostDoublings = 3;

// Layers are high enough when this share of the points have company within a column of that width
// (m): the reach of a window's dilated cells. Both are judgements.
constexpr double kMostWithCompany = 0.7, kColumn_m = 0.16;

// A reach holds this share of the scan's points: the farthest ones would ask for finer angles than
// they repay.
constexpr double kMostOfScan = 0.9;
// The shortest reach (m): an ordinary room and the corridor before it; then doubled.
constexpr double kShortestReach_m = 12.0;

// A scan that sees nothing farther away (m) is covered, by a lid or a hand: it tells nothing of
// where it is.
constexpr double kCovered_m = 0.5;

bool is_covered(const Cloud& cloud, const std::vector<std::uint32_t>& in_range) {
  return std::none_of(in_range.begin(), in_range.end(), [&](std::uint32_t i) {
    return (cloud.points[i] - cloud.origin(i)).norm() > kCovered_m;
  });
}

std::vector<std::uint32_t> within_range(const Cloud& cloud, double max_range_m) {
  std::vector<std::uint32_t> in_range;
  in_range.reserve(cloud.points.size());
  const auto range2 = static_cast<float>(max_range_m * max_range_m);
  for (std::uint32_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    if (in_lattice(p, kFinestResolution_m) && p.head<2>().squaredNorm() <= range2 &&
        in_lattice(cloud.origin(i), kFinestResolution_m))
      in_range.push_back(i);
  }
  if (is_covered(cloud, in_range)) in_range.clear();
  return in_range;
}

std::vector<std::uint32_t> within_heights(std::vector<std::uint32_t> in_range, const Cloud& cloud,
                                          const ScanConfig& config, double floor_z_m) {
  if (config.match_heights_m.empty()) return in_range;
  const auto low = static_cast<float>(floor_z_m + config.match_heights_m[0]),
             high = static_cast<float>(floor_z_m + config.match_heights_m[1]);
  std::erase_if(in_range, [&](std::uint32_t i) {
    return cloud.points[i].z() < low || cloud.points[i].z() > high;
  });
  return in_range;
}

// About every k-th of n numbers, at most `most`.
std::vector<std::size_t> spread_numbers(std::size_t n, std::size_t most) {
  const std::size_t kept = std::min(n, most);
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < kept; ++i) numbers.push_back(i * n / kept);
  return numbers;
}

double radius_of(const std::vector<Eigen::Vector3f>& points) {
  double farthest2 = 0.0;
  for (const Eigen::Vector3f& p : points)
    farthest2 = std::max(farthest2, p.head<2>().cast<double>().squaredNorm());
  return std::sqrt(farthest2);
}

// The share of points that are not alone in their cell.
double share_with_company(const std::vector<Eigen::Vector3f>& points, double height_m) {
  Numbering<Voxel> numbers(points.size());
  std::vector<int> in_cell;
  for (const Eigen::Vector3f& p : points) {
    const Voxel column = cell_at(p, 1.0 / kColumn_m), layer = cell_at(p, 1.0 / height_m);
    const std::uint32_t number = numbers.number({column.x, column.y, layer.z});
    if (number == in_cell.size()) in_cell.push_back(0);
    ++in_cell[number];
  }
  const auto alone = std::count(in_cell.begin(), in_cell.end(), 1);
  return 1.0 -
         static_cast<double>(alone) / static_cast<double>(std::max<std::size_t>(1, points.size()));
}

// The part, made now if it was not before.
template <class Part, class Make>
const Part& kept(std::optional<Part>& part, const Make& make) {
  if (!part) part = make();
  return *part;
}

}  // namespace

void check(const ScanConfig& config) {
  const std::vector<double>& band = config.match_heights_m;
  if (!band.empty() && (band.size() != 2 || band[0] >= band[1]))
    throw std::invalid_argument("match_heights_m must be [lowest, highest], or [] for all heights");
}

PreparedScan::PreparedScan(const Cloud& cloud, const ScanConfig& config, double floor_z_m)
    : cloud_(cloud),
      config_(config),
      in_range_(within_heights(within_range(cloud, config.max_range_m), cloud, config, floor_z_m)) {
}

double PreparedScan::reach_m() const {
  double reach_m = kShortestReach_m;
  const auto within = [&](std::uint32_t i) {
    return cloud_.points[i].head<2>().cast<double>().squaredNorm() <= reach_m * reach_m;
  };
  const double enough = kMostOfScan * static_cast<double>(in_range_.size());
  while (reach_m < config_.max_range_m &&
         static_cast<double>(std::count_if(in_range_.begin(), in_range_.end(), within)) < enough)
    reach_m *= 2.0;
  return std::min(reach_m, config_.max_range_m);
}

const std::vector<std::uint32_t>& PreparedScan::in_company() const {
  return kept(in_company_, [&] { return without_lonely(cloud_, in_range_); });
}

const MatchPoints& PreparedScan::points() const {
  return kept(points_, [&] {
    return taken(capped_by_layers(halved(upright_cubes()),
                                  {static_cast<std::size_t>(config_.refine_points), kMostOfUsual}));
  });
}

const MatchPoints& PreparedScan::few_points() const {
  return kept(few_points_, [&] { return some_of(points(), kFewPoints); });
}

MatchPoints PreparedScan::spatial_points() const {
  return taken(
      capped_by_layers(halved(cubes(0)), {static_cast<std::size_t>(config_.refine_points)}));
}

int PreparedScan::layer_doublings(double height_m, int most) const {
  int doublings = 0;
  while (doublings < most && share_with_company(points().points, height_m) < kMostWithCompany) {
    height_m *= 2.0;
    ++doublings;
  }
  return doublings;
}

std::vector<Eigen::Vector3f> PreparedScan::filter_points() const {
  return taken(capped_by_layers(upright_cubes(),
                                {static_cast<std::size_t>(config_.refine_points), kMostOfUsual}))
      .points;
}

std::vector<Eigen::Vector3f> PreparedScan::search_points(const Indices& telling) const {
  std::vector<InCube> cubes = thinned(cloud_.points, telling);
  if (cubes.size() < kEnoughToSearch) return taken(telling).points;
  for (int i = 0; i < kMostDoublings; ++i) {
    std::vector<InCube> wider = halved(cubes);
    if (wider.size() < kEnoughToSearch) break;
    cubes = std::move(wider);
  }
  return taken(capped_by_layers(std::move(cubes), {telling.size()})).points;
}

// Points that are alone would count more than others, each in a cube of its own.
std::vector<ScanRay> PreparedScan::lost_rays(std::size_t level) const {
  std::vector<InCube> cubes = thinned(cloud_.points, in_company());
  for (std::size_t i = 0; i < level; ++i) cubes = halved(cubes);
  return rays(capped_by_layers(std::move(cubes), {kMostRays}));
}

const std::vector<ScanRay>& PreparedScan::near_rays() const {
  return kept(near_rays_, [&] { return lost_rays(kNearLevel); });
}

const std::vector<ScanRay>& PreparedScan::even_rays() const {
  return kept(even_rays_, [&] { return lost_rays(kEvenLevel); });
}

const std::vector<ScanRay>& PreparedScan::few_rays() const {
  return kept(few_rays_, [&] { return rays(capped_by_layers(cubes(kEvenLevel), {kFewRays})); });
}

const std::vector<InCube>& PreparedScan::cubes(std::size_t level) const {
  return kept(cubes_[level], [&] {
    return level == 0 ? thinned(cloud_.points, in_range_) : halved(cubes(level - 1));
  });
}

// Finest cubes without those on flat surfaces.
std::vector<InCube> PreparedScan::upright_cubes() const {
  static_assert(kRefineLevel == 1);
  const std::vector<bool> flat = on_flat_surfaces(cloud_.points, in_range_);
  std::vector<InCube> upright = cubes(0);
  std::erase_if(upright, [&](const InCube& cube) { return flat[cube.index]; });
  const double least = kLeastUpright * static_cast<double>(cubes(0).size());
  return static_cast<double>(upright.size()) > least ? upright : cubes(0);
}

MatchPoints PreparedScan::taken(const Indices& indices) const {
  MatchPoints result;
  for (const std::uint32_t i : indices) {
    result.points.push_back(cloud_.points[i]);
    if (!cloud_.origins.empty()) result.origins.push_back(cloud_.origins[i]);
  }
  result.radius_m = radius_of(result.points);
  return result;
}

std::vector<ScanRay> PreparedScan::rays(const Indices& indices) const {
  std::vector<ScanRay> rays;
  for (const std::uint32_t i : indices) rays.push_back({cloud_.origin(i), cloud_.points[i]});
  return rays;
}

MatchPoints some_of(const MatchPoints& points, std::size_t most) {
  MatchPoints few;
  for (const std::size_t i : spread_numbers(points.points.size(), most)) {
    few.points.push_back(points.points[i]);
    if (!points.origins.empty()) few.origins.push_back(points.origins[i]);
  }
  few.radius_m = radius_of(few.points);
  return few;
}

}  // namespace voxlist::matching
