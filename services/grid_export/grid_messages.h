#pragma once

#include <cstdint>
#include <string>
#include <voxlist/pixel_map_t.hpp>
#include <voxlist/traversability_t.hpp>

#include "services/grid_export/banded_zlib.h"
#include "voxlist/planning/grids/typed_grid.h"

namespace voxlist::services {

/// The map that a grid is of.
struct GridSource {
  std::int64_t utime_us = 0;  ///< of the newest cloud in it
  std::int64_t map_id = 0, version = 0;

  bool operator==(const GridSource&) const = default;
};

/// What may be driven on, as occ_map's readers have it. `zlib` has seen nothing, or the pixels of
/// an earlier grid, which saves time.
pixel_map_t to_pixel_map(const planning::TypedGrid& grid, const GridSource& source,
                         BandedZlib& zlib);

/// All types, with the map's id and version. `zlib` has seen nothing, or the types of an earlier
/// grid.
traversability_t to_traversability(const planning::TypedGrid& grid, const GridSource& source,
                                   const std::string& profile, BandedZlib& zlib);

}  // namespace voxlist::services
