#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace voxlist::io {

/// Unpacks LZF (the compression of PCD's binary_compressed) into exactly `size` bytes.
/// Throws FormatError when the input is damaged or is not of that size; `size` is checked before it
/// is allocated.
std::string unpack_lzf(std::string_view packed, std::size_t size);

}  // namespace voxlist::io
