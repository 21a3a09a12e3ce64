#pragma once

#include <filesystem>

#include "tests/bench/test_floor.h"

namespace voxlist::bench {

/// A floor of that length and depth (m) without its map.
TestFloor large_floor(double length_m, double depth_m, int seed);

/// The seed of the floor that large_map has made a folder of: it is the map's id.
int seed_of(const std::filesystem::path& folder);

}  // namespace voxlist::bench
