#include "voxlist/matching/counting/coarse_map.h"

#include <cmath>

namespace voxlist::matching {

CoarseMap::CoarseMap(const DilatedMap& map, double reach_m) : reach_m_(reach_m) {
  // A point looks up to so many coarse cells ahead: what a wide grid spans.
  constexpr std::int32_t kLooksAhead = 3;
  margin_ = static_cast<std::int32_t>(std::ceil(reach_m / (map.cell_m() * kFactor))) + kLooksAhead;
  size_x_ = (map.size_x() + kFactor - 1) / kFactor;
  size_y_ = (map.size_y() + kFactor - 1) / kFactor;
  size_z_ = map.size_z();
  rows_ = size_y_ + 2 * margin_;
  row_bits_ = size_x_ + 2 * margin_;
  free_bit_ = 4 * size_z_ * rows_ * row_bits_;
  // A sweep reads whole vectors (of 8 words, twice) past its window's end, and free cells over a
  // whole window.
  constexpr std::int64_t kVectorWords = 16;
  words_.assign(static_cast<std::size_t>((free_bit_ + rows_ * row_bits_) / 64 + kVectorWords), 0);
  for (std::int32_t z = 0; z < size_z_; ++z)
    for (std::int32_t y = 0; y < size_y_; ++y)
      for (std::int32_t x = 0; x < size_x_; ++x) {
        if (map.window_anywhere(x * kFactor, y * kFactor, z) == 0) continue;
        for (const bool wide_y : {false, true})
          for (const bool wide_x : {false, true})
            for (int dy = 0; dy <= 1 + wide_y; ++dy)
              for (int dx = 0; dx <= 1 + wide_x; ++dx) set(bit(wide_x, wide_y, x - dx, y - dy, z));
      }
}

}  // namespace voxlist::matching
