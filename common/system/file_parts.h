#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace voxlist {

/// Files that were written one after the other because each has a limit: NAME.00, NAME.01, ... of
/// lcm-logger.
struct FileParts {
  std::vector<std::filesystem::path> files;    ///< in their order
  std::vector<std::filesystem::path> missing;  ///< not there, though later ones are
};

/// The parts of what has this name. A file of that very name is the only part; so is a name of
/// which nothing is there.
FileParts parts_of(const std::filesystem::path& name);

/// The name whose parts a file belongs to, with at least one more part there. Empty when the file
/// stands by itself.
std::filesystem::path whole_of(const std::filesystem::path& file);

}  // namespace voxlist
