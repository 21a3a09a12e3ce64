#pragma once

#include <string_view>

namespace voxlist::io {

/// Whether a comes before b as people sort names: runs of digits count as numbers, so scan_9 before
/// scan_10.
bool natural_less(std::string_view a, std::string_view b);

}  // namespace voxlist::io
