#include "voxlist/matching/scan/match_points.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "voxlist/geometry/elementary.h"
#include "voxlist/voxels/fast_cell.h"
#include "voxlist/voxels/numbering.h"

namespace voxlist::matching {
namespace {

using Indices = std::vector<std::uint32_t>;

// Which point of a cell is kept: none is nearer to one side of the cell than to another, which the
// first by its coordinates would be (and pull the pose along by millimetres).
std::uint64_t lot(const Eigen::Vector3f& p) {
  std::uint64_t lot = 0;
  for (const float value : p)
    lot = (lot ^ std::bit_cast<std::uint32_t>(value)) * 0x9e3779b97f4a7c15u;
  return lot ^ lot >> 32;
}

// Sums over the points of a cube, in finest voxels from the cube's lowest: whole numbers, whose
// sums know no order.
struct Spread {
  std::int64_t n = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, yy = 0, zz = 0;

  void add(std::int64_t vx, std::int64_t vy, std::int64_t vz) {
    ++n;
    x += vx, y += vy, z += vz;
    xx += vx * vx, xy += vx * vy, yy += vy * vy, zz += vz * vz;
  }

  // Whether the points lie flat: wide both ways over the ground (a line of points on a wall is
  // not), and thin in height. Slopes up to about 22 deg count as flat.
  bool flat() const {
    constexpr std::int64_t kFewest = 6;
    constexpr double kFlatness = 2.5, kThickest = 3.0;
    if (n < kFewest) return false;
    const auto variance = [this](std::int64_t ab, std::int64_t a, std::int64_t b) {
      const auto count = static_cast<double>(n);
      return (static_cast<double>(ab) - static_cast<double>(a * b) / count) / count;
    };
    const double vx = variance(xx, x, x), vy = variance(yy, y, y), vxy = variance(xy, x, y);
    const double narrow = (vx + vy) / 2.0 - elementary::hypot((vx - vy) / 2.0, vxy);
    const double height = variance(zz, z, z);
    return height < kThickest * kThickest && narrow > kFlatness * kFlatness * (height + 1.0 / 12.0);
  }
};

Indices within_range(std::span<const Eigen::Vector3f> points, double max_range_m) {
  Indices in_range;
  const auto range2 = static_cast<float>(max_range_m * max_range_m);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (in_lattice(points[i], kFinestResolution_m) && points[i].head<2>().squaredNorm() <= range2)
      in_range.push_back(i);
  }
  return in_range;
}

// The points that do not belong to a flat-lying surface; all when these are few.
Indices upright(std::span<const Eigen::Vector3f> points, const Indices& in_range,
                double flat_cube_m) {
  constexpr double kFewestKept = 0.05;  // of all points
  const auto edge =
      std::max(1, static_cast<std::int32_t>(std::lround(flat_cube_m / kFinestResolution_m)));
  Numbering numbers(in_range.size());
  std::vector<Spread> cubes;
  Indices cube_of;
  cube_of.reserve(in_range.size());
  for (const std::uint32_t i : in_range) {
    const Voxel v = cell_at(points[i], 1.0 / kFinestResolution_m);
    const Voxel cube{floor_div(v.x, edge), floor_div(v.y, edge), floor_div(v.z, edge)};
    const std::uint32_t number = numbers.number(key_of(cube));
    if (number == cubes.size()) cubes.emplace_back();
    cubes[number].add(v.x - cube.x * edge, v.y - cube.y * edge, v.z - cube.z * edge);
    cube_of.push_back(number);
  }
  std::vector<bool> flat;
  for (const Spread& cube : cubes) flat.push_back(cube.flat());
  Indices kept;
  for (std::size_t i = 0; i < in_range.size(); ++i) {
    if (!flat[cube_of[i]]) kept.push_back(in_range[i]);
  }
  const auto fewest = static_cast<std::size_t>(kFewestKept * static_cast<double>(in_range.size()));
  return kept.size() > fewest ? kept : in_range;
}

struct InCell {
  std::uint64_t key, lot;
  std::uint32_t index;
};

// One point of each cell, drawn by lot, by layer, row and column.
std::vector<InCell> one_per_cell(std::span<const Eigen::Vector3f> points, const Indices& from,
                                 double spacing_m) {
  Numbering numbers(from.size());
  std::vector<InCell> cells;
  for (const std::uint32_t i : from) {
    const std::uint64_t key = key_of(cell_at(points[i], 1.0 / spacing_m));
    const std::uint64_t drawn = lot(points[i]);
    const std::uint32_t number = numbers.number(key);
    if (number == cells.size())
      cells.push_back({key, drawn, i});
    else if (drawn < cells[number].lot)
      cells[number] = {key, drawn, i};
  }
  std::sort(cells.begin(), cells.end(), [](auto& a, auto& b) { return a.key < b.key; });
  return cells;
}

// Cells of one layer each.
std::vector<std::span<const InCell>> layers_of(std::span<const InCell> cells) {
  std::vector<std::span<const InCell>> layers;
  for (std::size_t from = 0; from < cells.size();) {
    std::size_t to = from;
    while (to < cells.size() && layer_of(cells[to].key) == layer_of(cells[from].key)) ++to;
    layers.push_back(cells.subspan(from, to - from));
    from = to;
  }
  return layers;
}

// The largest cap on a layer's points that keeps the total within max_points, and no layer far
// above the usual one: walls give each layer a line of points, a floor or a ceiling gives its own a
// whole area.
std::size_t layer_cap(const std::vector<std::span<const InCell>>& layers, std::size_t max_points) {
  constexpr double kAboveUsual = 1.5;
  std::vector<std::size_t> counts;
  for (const auto& layer : layers) counts.push_back(layer.size());
  if (counts.empty()) return 0;
  std::nth_element(counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2),
                   counts.end());
  const double usual = static_cast<double>(counts[counts.size() / 2]);
  std::size_t low = 0,
              high = std::min(max_points, static_cast<std::size_t>(kAboveUsual * usual) + 1);
  while (low < high) {
    const std::size_t cap = (low + high + 1) / 2;
    std::size_t total = 0;
    for (const auto& layer : layers) total += std::min(layer.size(), cap);
    (total <= max_points ? low : high) = total <= max_points ? cap : cap - 1;
  }
  return low;
}

Indices chosen(std::span<const Eigen::Vector3f> points, const MatchPointsConfig& config) {
  const Indices in_range = within_range(points, config.max_range_m);
  const auto cells =
      one_per_cell(points, upright(points, in_range, config.flat_cube_m), config.spacing_m);
  const auto layers = layers_of(cells);
  const std::size_t cap = layer_cap(layers, static_cast<std::size_t>(config.max_points));
  Indices indices;
  for (const auto& layer : layers) {
    const std::size_t kept = std::min(layer.size(), cap);
    for (std::size_t i = 0; i < kept; ++i) indices.push_back(layer[i * layer.size() / kept].index);
  }
  return indices;
}

MatchPoints taken(const RayPoints& scan, const Indices& indices) {
  MatchPoints result;
  result.points.reserve(indices.size());
  double farthest2 = 0.0;
  for (const std::uint32_t i : indices) {
    const Eigen::Vector3f& p = scan.points[i];
    result.points.push_back(p);
    if (!scan.origins.empty()) result.origins.push_back(scan.origins[i]);
    farthest2 = std::max(farthest2, p.head<2>().cast<double>().squaredNorm());
  }
  result.radius_m = std::sqrt(farthest2);
  return result;
}

}  // namespace

MatchPoints choose_match_points(const RayPoints& scan, const MatchPointsConfig& config) {
  return taken(scan, chosen(scan.points, config));
}

MatchPoints some_of(const MatchPoints& points, std::size_t most) {
  const std::size_t kept = std::min(points.points.size(), most);
  Indices indices;
  for (std::size_t i = 0; i < kept; ++i)
    indices.push_back(static_cast<std::uint32_t>(i * points.points.size() / kept));
  return taken(points, indices);
}

}  // namespace voxlist::matching
