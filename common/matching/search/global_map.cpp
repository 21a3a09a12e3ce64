#include "voxlist/matching/search/global_map.h"

#include <algorithm>
#include <cmath>

namespace voxlist::matching {
namespace {

// A scan reaches at most so many cells: the angles of a lattice grow with it, to 5000 here (0.07
// deg), and so do the grids' margins. With cells of 0.04 m it is 32 m. More: slower by the square;
// fewer: scans that reach far are searched in coarser cells than they need. A judgement.
constexpr double kMostReachCells = 800.0;

// A layer of which the map fills this share of its ground plan is a floor or a ceiling, whose
// points match wherever the robot is. Walls fill far less; the limit is a judgement.
constexpr double kFull = 0.5;

// Where less than this share of the points lies outside such layers, these few tell nothing, and
// all are kept.
constexpr double kFewestKept = 0.05;

double cell_for(double finest_m, double reach_m) {
  double cell_m = finest_m;
  while (reach_m > kMostReachCells * cell_m) cell_m *= 2.0;
  return cell_m;
}

// The numbers below n in an order of which any first part is spread evenly, so that hopeless poses
// are given up early: by their fractions of the golden ratio.
std::vector<std::size_t> golden_order(std::size_t n) {
  constexpr double kGolden = 0.6180339887498949;
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < n; ++i)
    order.emplace_back(std::fmod(static_cast<double>(i) * kGolden, 1.0), i);
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> numbers;
  for (const auto& [fraction, number] : order) numbers.push_back(number);
  return numbers;
}

}  // namespace

GlobalMap::GlobalMap(const VoxelMap& map, double finest_m, double reach_m)
    : dilated_(map, cell_for(finest_m, reach_m), reach_m), coarse_(dilated_, reach_m) {}

bool GlobalMap::within_reach(const Eigen::Vector3f& p) const {
  return in_lattice(p, kFinestResolution_m) &&
         p.head<2>().cast<double>().squaredNorm() <= coarse_.reach_m() * coarse_.reach_m();
}

std::vector<Eigen::Vector3f> GlobalMap::choose_points(const PreparedScan& scan,
                                                      std::size_t most) const {
  const auto points = scan.search_points(telling(scan));
  std::vector<Eigen::Vector3f> chosen;
  const std::size_t n = std::min({most, kMostSearchPoints, points.size()});
  for (const std::size_t i : golden_order(n)) chosen.push_back(points[i * points.size() / n]);
  return chosen;
}

// Indices of the points within reach that do not lie in layers which the map fills. They are left
// out before the scan is thinned: the cubes at the foot of a wall would else be the floor's.
std::vector<std::uint32_t> GlobalMap::telling(const PreparedScan& scan) const {
  std::vector<std::uint32_t> near, telling;
  for (const std::uint32_t i : scan.in_company()) {
    const Eigen::Vector3f& p = scan.cloud().points[i];
    if (!within_reach(p)) continue;
    near.push_back(i);
    if (dilated_.fill(dilated_.layer(double(p.z()))) < kFull) telling.push_back(i);
  }
  return double(telling.size()) < kFewestKept * double(near.size()) ? near : telling;
}

}  // namespace voxlist::matching
