#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace voxlist::io {

/// The files of a folder that are scans, in the natural order of their names.
struct ScanFiles {
  std::vector<std::filesystem::path> files;

  /// What a person should know: what looks like a scan and is left out.
  std::vector<std::string> notes;
};

/// Looks into a folder, as ScanFolder says. Throws FileError when there is no scan in it, with what
/// is there, and when a scan is there in two formats.
ScanFiles find_scan_files(const std::filesystem::path& folder);

}  // namespace voxlist::io
