#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace voxlist::matching {

/// Edge of the finest cubes (m) of which one point is kept. Small things that tell two alike rooms
/// apart are a few of these wide. Coarser cubes are two, four and eight of these wide.
inline constexpr double kFinestCube_m = 0.05;

/// The point that is kept of a cube.
struct InCube {
  /// The cube: ascending by layer, row and column.
  std::uint64_t key;
  /// The lowest lot of the cube's points. Which point has it depends on the points alone, not on
  /// their order, and none is nearer to one side of the cube than to another, which the first by
  /// its coordinates would be (and pull the pose along by millimetres).
  std::uint64_t lot;
  /// Of the point in the scan.
  std::uint32_t index;
};

/// One point of each finest cube, in no fixed order. The points must lie in the voxels' lattice.
std::vector<InCube> thinned(std::span<const Eigen::Vector3f> points,
                            std::span<const std::uint32_t> indices);

/// One point of each cube of twice the edge: the same as thinning all points at once.
std::vector<InCube> halved(std::span<const InCube> cubes);

/// Puts the cubes into the order of their keys.
void sort_by_layers(std::vector<InCube>& cubes);

/// How many points a layer of cubes may keep.
struct LayerLimit {
  /// Layers are capped alike until so many points hold all.
  std::size_t most_points;
  /// No layer keeps more than this multiple of the median layer's. Walls give each layer a line of
  /// points, a floor or a ceiling gives its own a whole area.
  double most_of_usual = std::numeric_limits<double>::infinity();
};

/// Indices of the points that remain, each layer's spread evenly over it; by layers, rows and
/// columns.
std::vector<std::uint32_t> capped_by_layers(std::vector<InCube> cubes, const LayerLimit& limit);

}  // namespace voxlist::matching
