#include "services/voxlist/recording/recording.h"

#include "voxlist/io/files/file.h"

namespace voxlist::desk {

std::unique_ptr<Recording> open_recording(const std::filesystem::path& path, Omissions& omissions) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    throw io::FileError(path, "is not there, give a folder of scans or an LCM log");
  }
  return std::filesystem::is_directory(path, ignored) ? open_folder_recording(path, omissions)
                                                      : open_log_recording(path, omissions);
}

}  // namespace voxlist::desk
