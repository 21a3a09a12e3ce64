#pragma once

#include <string_view>

#include "voxlist/geometry/cloud.h"
#include "voxlist/io/clouds/raw_scan.h"

namespace voxlist::io {

/// The cloud in a PCD file's bytes (version 0.7: ascii, binary, binary_compressed). Throws
/// FormatError on damage. With `further` it keeps all columns (RawScan).
Cloud parse_pcd(std::string_view bytes, FurtherColumns* further = nullptr);

}  // namespace voxlist::io
