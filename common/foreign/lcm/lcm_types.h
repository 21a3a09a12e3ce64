#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "voxlist/bus/wire.h"

namespace voxlist::foreign {

/// One of the project's message types.
struct LcmType {
  /// The first eight bytes of each message.
  std::int64_t fingerprint;
  /// Such as voxlist.pose_t.
  std::string_view name;
  /// The .lcm file.
  std::string_view text;
};

/// All of lcmtypes/; the build makes the table of them.
std::span<const LcmType> lcm_types();

/// The type of an encoded message, whatever its channel; null where it is somebody else's.
const LcmType* lcm_type_of(bus::Bytes message);

/// The texts of the type and of all types in it: what is needed to decode its messages.
std::string definition_of(const LcmType& type);

}  // namespace voxlist::foreign
