#pragma once

#include <string>

namespace voxlist::desk {

/// A number with that many decimals.
std::string fixed(double value, int decimals);

/// Text made at least `width` wide, with blanks before it, or behind it for a negative width.
std::string padded(const std::string& text, int width);

}  // namespace voxlist::desk
