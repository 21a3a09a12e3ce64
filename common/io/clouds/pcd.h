#pragma once

#include <string_view>

#include "voxlist/geometry/cloud.h"

namespace voxlist::io {

/// The cloud in a PCD file's bytes (version 0.7: ascii, binary, binary_compressed). Throws
/// FormatError on damage.
Cloud parse_pcd(std::string_view bytes);

}  // namespace voxlist::io
