#pragma once

#include <string_view>

#include "voxlist/geometry/cloud.h"
#include "voxlist/io/clouds/raw_scan.h"

namespace voxlist::io {

/// The cloud in a .bin file as the KITTI data sets have them: x, y, z and intensity of each point,
/// 32-bit floats with the lowest byte first, and nothing else. Drops points that are not finite,
/// unless `further` gets the intensities. Throws FormatError when the bytes are no such rows, or
/// lie where no laser measures.
Cloud parse_kitti(std::string_view bytes, FurtherColumns* further = nullptr);

}  // namespace voxlist::io
