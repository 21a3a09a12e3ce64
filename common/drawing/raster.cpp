#include "voxlist/drawing/raster.h"

#include <algorithm>

namespace voxlist::drawing {

void Raster::fill(int left, int top, int right, int bottom, io::Rgb colour) {
  left = std::clamp(left, 0, width);
  right = std::clamp(right, left, width);
  for (int y = std::max(top, 0); y < std::min(bottom, height); ++y) {
    const auto row = pixels.begin() + static_cast<std::ptrdiff_t>(y) * width;
    std::fill(row + left, row + right, colour);
  }
}

}  // namespace voxlist::drawing
