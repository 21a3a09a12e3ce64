#pragma once

#include <string_view>

#include "voxlist/geometry/cloud.h"
#include "voxlist/io/clouds/raw_scan.h"

namespace voxlist::io {

/// The cloud in a PLY file's bytes (ASCII or binary of either byte order). Throws FormatError on
/// damage. With `further` it keeps all columns (RawScan).
Cloud parse_ply(std::string_view bytes, FurtherColumns* further = nullptr);

}  // namespace voxlist::io
