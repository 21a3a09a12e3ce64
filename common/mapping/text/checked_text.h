#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace voxlist::mapping {

/// The text with a last line that has its checksum.
std::string with_checksum(std::string text);

/// The text before its last line, if that has the checksum of it.
std::optional<std::string_view> whole_text(std::string_view text);

}  // namespace voxlist::mapping
