#pragma once

#include <filesystem>
#include <string_view>

namespace voxlist::io {

/// Writes a whole file so that whoever opens it, even after a crash or a power cut, finds either
/// the old content or the new one, complete: a temporary file beside it is written, synced and
/// renamed over it. Throws FileError (full disk, no permission, path is not a regular file); then
/// the old file is untouched and the temporary one is gone. A symbolic link is replaced by the
/// file.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace voxlist::io
