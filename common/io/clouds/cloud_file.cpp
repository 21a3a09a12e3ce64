#include "voxlist/io/clouds/cloud_file.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "voxlist/io/clouds/kitti.h"
#include "voxlist/io/clouds/pcd.h"
#include "voxlist/io/clouds/ply.h"
#include "voxlist/io/clouds/raw_scan.h"
#include "voxlist/io/files/cursor.h"
#include "voxlist/io/files/file_kind.h"

namespace voxlist::io {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return extension;
}

// What a file says of itself goes before its name.
Cloud parse(std::string_view bytes, const std::string& extension, FurtherColumns* further) {
  if (extension == ".bin") return parse_kitti(bytes, further);
  const bool is_ply = bytes.starts_with("ply"), is_pcd = bytes.starts_with("# .PCD");
  return is_ply || (extension == ".ply" && !is_pcd) ? parse_ply(bytes, further)
                                                    : parse_pcd(bytes, further);
}

Cloud read(const std::filesystem::path& path, FurtherColumns* further) {
  const std::string extension = lower_extension(path);
  if (extension != ".ply" && extension != ".pcd" && extension != ".bin") {
    throw FileError(path, "neither .ply nor .pcd, convert the scan to one of these");
  }
  const std::string bytes = read_file(path);
  try {
    return parse(extension == ".bin" ? bytes : without_mark(bytes), extension, further);
  } catch (const FormatError& error) {
    if (const std::string what = what_it_is(bytes); !what.empty()) throw FileError(path, what);
    throw FileError(path, std::string(error.what()) + "; copy or export the scan again");
  }
}

}  // namespace

Cloud read_cloud_file(const std::filesystem::path& path) { return read(path, nullptr); }

RawScan read_raw_scan(const std::filesystem::path& path) {
  RawScan scan;
  scan.cloud = read(path, &scan.further);
  return scan;
}

}  // namespace voxlist::io
