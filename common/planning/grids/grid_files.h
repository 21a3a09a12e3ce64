#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "voxlist/drawing/raster.h"
#include "voxlist/planning/grids/typed_grid.h"

namespace voxlist::planning {

/// Whether a cell of a robot's floor plan may be driven on, as planners' grids have it.
enum class Drivable { kFree, kUnknown, kBlocked };

Drivable drivable(CellType type);

/// One byte a cell for pixel_map_t, in the grid's order: 0 free, 127 unknown, 255 not free.
std::vector<std::uint8_t> likelihoods(const TypedGrid& grid);

/// The grid's lowest corner in the map (m).
Eigen::Vector2d corner_m(const CellBox& box);

/// A PGM for Nav2's map_server, the highest y first: 254 free, 0 not free, 128 unknown. With its
/// YAML it reads as the same grid under a free_thresh of 0.196 and of 0.25.
std::string pgm(const TypedGrid& grid);

/// The YAML to a PGM of this name in the same folder.
std::string yaml(const CellBox& box, const std::string& pgm_name);

/// A pixel a cell, the highest y on top: free white, obstacles black, overhangs orange, negative
/// blue, unknown grey.
drawing::Raster typed_raster(const TypedGrid& grid);

/// Sides of the largest image that programs are sure to read (pixels).
inline constexpr std::int32_t kLargestImage = 8192;

/// A part of a grid as an image of its own, and what its name gets behind the profile's.
struct GridTile {
  std::string suffix;
  CellBox box;
};

/// The whole box where it is no larger than `side` cells, else parts of it: "_X_Y", counted from
/// the lowest x and y.
std::vector<GridTile> tiles_of(const CellBox& box, std::int32_t side = kLargestImage);

/// A part of a grid. Precondition: it lies in the grid's box.
TypedGrid part_of(const TypedGrid& grid, const CellBox& box);

/// Writes NAME.pgm, NAME.yaml and NAME.png into a folder, each atomically. Throws io::FileError,
/// and std::length_error above kLargestImage.
void write_grid(const TypedGrid& grid, const std::filesystem::path& folder,
                const std::string& name);

}  // namespace voxlist::planning
