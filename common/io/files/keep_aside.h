#pragma once

#include <filesystem>
#include <string>

namespace voxlist::io {

/// Gives a file a second name beside its own, so that it is still there when FILE is replaced:
/// FILE + ending, or where that is taken FILE + ending + "-1", "-2" and so on. Returns the name. On
/// a file system without hard links it is a full copy, synced. Throws FileError.
std::filesystem::path keep_aside(const std::filesystem::path& file, const std::string& ending);

/// The first of PATH + ending + "-1", "-2", ... that nothing has. Throws FileError when there are
/// too many.
std::filesystem::path free_name(const std::filesystem::path& path, const std::string& ending);

}  // namespace voxlist::io
