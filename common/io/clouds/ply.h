#pragma once

#include <string_view>

#include "voxlist/geometry/cloud.h"

namespace voxlist::io {

/// The cloud in a PLY file's bytes (ASCII or binary of either byte order). Throws FormatError on
/// damage.
Cloud parse_ply(std::string_view bytes);

}  // namespace voxlist::io
