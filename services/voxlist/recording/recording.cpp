#include "services/voxlist/recording/recording.h"

#include "voxlist/io/files/file.h"
#include "voxlist/io/packets/pcap_file.h"
#include "voxlist/system/file_parts.h"

namespace voxlist::desk {

std::unique_ptr<Recording> open_recording(const std::filesystem::path& path,
                                          const std::string& prefix, Omissions& omissions,
                                          const RawChannels& raw) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    return open_folder_recording(path, omissions, raw);
  if (!std::filesystem::exists(parts_of(path).files.front(), ignored))
    throw io::FileError(path, "is not there, give a folder of scans or an LCM log");
  if (io::is_pcap(path)) return open_pcap_recording(path, omissions, raw);
  return open_log_recording(path, prefix, omissions, raw);
}

}  // namespace voxlist::desk
