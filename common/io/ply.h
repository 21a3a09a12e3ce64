#pragma once

#include <string_view>

#include "geometry/cloud.h"

namespace voxlist {

/// The cloud in a PLY file's bytes (ASCII or binary of either byte order). Throws FormatError on
/// damage.
Cloud parse_ply(std::string_view bytes);

}  // namespace voxlist
