#pragma once

#include <cstdint>

namespace voxlist {

/// Bytes of memory that the machine has; 1 GB where it does not tell.
std::int64_t memory_of_machine();

}  // namespace voxlist
