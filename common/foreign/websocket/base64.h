#pragma once

#include <string>
#include <string_view>

namespace voxlist::foreign {

/// Bytes as JSON can hold them (RFC 4648, with padding).
std::string base64(std::string_view bytes);

}  // namespace voxlist::foreign
