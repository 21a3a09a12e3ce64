#pragma once

#include <cstdint>

namespace voxlist {

/// Bytes of memory that the machine has; 1 GB where it does not tell.
std::int64_t memory_of_machine();

/// Bytes of it that this process holds now; 0 where the system does not tell.
std::int64_t memory_of_process();

/// Gives the system what this process has freed: after something large, which is not needed again
/// soon. Milliseconds.
void give_memory_back();

}  // namespace voxlist
