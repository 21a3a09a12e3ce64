#pragma once

#include <string>
#include <vector>

#include "voxlist/drawing/picture.h"

namespace voxlist::test {

/// What libpng reads from a picture's PNG file.
struct Pixels {
  io::Rgb at(int x, int y) const;
  std::size_t count(io::Rgb colour) const;

  int width = 0;
  int height = 0;
  std::vector<io::Rgb> rgb;  ///< row after row
};

/// Writes the picture as PNG and reads it back.
Pixels pixels_of(const drawing::Picture& picture);

/// Whether tags are closed in the order that they were opened in, and one encloses all others.
bool is_xml(const std::string& text);

}  // namespace voxlist::test
