#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace voxlist::test {

/// A fresh empty folder, gone with everything in it at the end.
class WorkFolder {
 public:
  WorkFolder();
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// Number of scans in a scan set: one a second.
inline constexpr int kScans = 12;

/// Writes what a simulated robot recorded in its first seconds: scan_000.ply and so on, poses.csv
/// and odometry.csv.
void make_scan_set(const std::string& folder);

/// What a run of the tool came to.
struct DeskRun {
  int exit_code;
  std::string out;
  std::string err;
};

/// Runs the tool in this process, as on a pipe.
DeskRun run(std::vector<std::string> arguments);

std::string read_text(const std::string& path);
void write_text(const std::string& path, const std::string& text);

/// The lines of a text file.
std::vector<std::string> read_lines(const std::string& path);

}  // namespace voxlist::test
