#pragma once

namespace voxlist::bench {

/// Prints time and memory of the grids of a floor of 200 x 150 m for a low robot and a tall one:
/// all of it at once, and what one cloud adds.
void run_large_floor();

}  // namespace voxlist::bench
