#pragma once

#include <string_view>

/// Checks of what a function's documentation asks of its caller. A failed check is a fault of this
/// program, never of its input: it prints the expression, the message, the file and the line, and
/// aborts. VOXLIST_CHECKS is 1 in Debug builds and with sanitizers (common/CMakeLists.txt). It is 0
/// in Release, where a check is compiled but not evaluated, so that one in an inner loop is free.
#ifndef VOXLIST_CHECKS
#define VOXLIST_CHECKS 0
#endif

#if VOXLIST_CHECKS
#define VOXLIST_CHECK(condition, message) \
  ((condition) ? void() : ::voxlist::check_failed(#condition, message, __FILE__, __LINE__))
#else
#define VOXLIST_CHECK(condition, message) void(sizeof(!(condition)))
#endif

namespace voxlist {

/// Prints what failed to standard error and aborts. VOXLIST_CHECK calls it.
[[noreturn]] void check_failed(std::string_view condition, std::string_view message,
                               std::string_view file, int line);

}  // namespace voxlist
