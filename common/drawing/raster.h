#pragma once

#include <cstddef>
#include <vector>

#include "voxlist/io/clouds/colour.h"

namespace voxlist::drawing {

/// An image of pixels, row after row from the top.
struct Raster {
  Raster(int width_pixels, int height_pixels, io::Rgb background)
      : width(width_pixels),
        height(height_pixels),
        pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), background) {}

  /// Fills the pixels from `left` to `right` - 1 and from `top` to `bottom` - 1 that are inside.
  void fill(int left, int top, int right, int bottom, io::Rgb colour);

  int width;
  int height;
  std::vector<io::Rgb> pixels;
};

}  // namespace voxlist::drawing
