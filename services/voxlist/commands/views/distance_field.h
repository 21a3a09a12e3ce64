#pragma once

#include <string>
#include <vector>

#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::desk {

/// How far each cell of a box is from the nearest cell that is not free: occupied, or unknown. To
/// the cells' centres (m), never more than was asked for.
struct DistanceField {
  VoxelBox box;              ///< cells of kPassedResolution_m, both corners included
  std::vector<float> far_m;  ///< x first, then y, then z

  std::size_t count(int axis) const;
};

/// The box of all cells where a map's free space tells something; none without any.
std::optional<VoxelBox> known_box(const OccupancyMap& free_space);

/// Cells that one field may have: it takes about 40 bytes a cell to make.
inline constexpr std::size_t kMostFieldCells = 32'000'000;

/// The field in a box, by dynamicEDT3D. What is outside of the box counts as well, up to most_m. A
/// cell is free where free space says so and no voxel of the map lies in it. Throws
/// std::length_error above kMostFieldCells.
DistanceField distance_field(const OccupancyMap& map, const OccupancyMap& free_space,
                             const VoxelBox& box, double most_m);

/// The field as a NumPy file: an array of float32, [z][y][x].
std::string npy(const DistanceField& field);

/// Where its first cell's lowest corner is, and its resolution (m).
std::string place_yaml(const DistanceField& field, const std::string& npy_name, double most_m);

}  // namespace voxlist::desk
