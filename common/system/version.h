#pragma once

#include <string>

namespace voxlist {

/// "0.1.0 (1ba85f4c)": the project's number, and the commit that the program was built from where
/// that is known, with a + behind it when files were changed since.
std::string version();

}  // namespace voxlist
