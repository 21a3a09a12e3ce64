#include "voxlist/io/scans/scan_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <system_error>

#include "voxlist/io/files/cursor.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/files/natural_order.h"

namespace voxlist::io {
namespace {

namespace fs = std::filesystem;
using Files = std::vector<fs::path>;

// Entries of a long list that are told.
constexpr std::size_t kTold = 3;

std::string lower_name(const fs::path& file) { return lower_case(file.filename().string()); }

// Whether a file's name may be a scan's: it is not hidden, and not the map that Voxlist makes.
bool looks_like_scan(const fs::path& file) {
  const std::string name = lower_name(file);
  return (name.ends_with(".ply") || name.ends_with(".pcd")) && !name.starts_with('.') &&
         name != "map.ply";
}

// A scan of the KITTI data sets. Such files may be anything, so others go before them.
bool looks_like_kitti(const fs::path& file) {
  const std::string name = lower_name(file);
  return name.ends_with(".bin") && !name.starts_with('.');
}

bool is_named_scan(const fs::path& file) { return lower_name(file).starts_with("scan_"); }

Files files_in(const fs::path& folder) {
  std::error_code failure;
  Files files;
  for (const auto& entry : fs::directory_iterator(folder, failure)) files.push_back(entry.path());
  if (failure)
    throw FileError(folder, "no folder that can be read, give the folder that holds the scans");
  std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return files;
}

// "a.ply, b.ply, c.ply and 7 more".
std::string names_of(const Files& files) {
  std::string names;
  for (std::size_t i = 0; i < std::min(files.size(), kTold); ++i)
    names += (i == 0 ? "" : ", ") + files[i].filename().string();
  if (files.size() > kTold) names += fmt::format(" and {} more", files.size() - kTold);
  return names;
}

Files take_out(Files& files, bool (*is_out)(const fs::path&)) {
  const auto out = std::ranges::stable_partition(files, [&](const auto& f) { return !is_out(f); });
  Files taken(out.begin(), out.end());
  files.erase(out.begin(), out.end());
  return taken;
}

bool is_no_file(const fs::path& file) {
  std::error_code ignored;
  return !fs::is_regular_file(file, ignored);
}

// "4 .gz, 1 .txt": what a folder without scans holds.
std::string endings_of(const Files& files) {
  std::map<std::string, int> counts;
  for (const fs::path& file : files)
    if (!is_no_file(file)) ++counts[lower_case(file.extension().string())];
  std::string text;
  for (const auto& [ending, count] : counts)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count,
                        ending.empty() ? "without an ending" : ending);
  return text.empty() ? "no file" : text;
}

void refuse(const fs::path& folder, const Files& all, const ScanFiles& scans) {
  std::string why = fmt::format(
      "has no scans, put scan_000.ply (or .pcd), scan_001.ply, ... "
      "there; it holds {}",
      endings_of(all));
  if (!scans.notes.empty()) why += "; " + scans.notes.front();
  throw FileError(folder, why);
}

void refuse_two_formats(const Files& files) {
  for (std::size_t i = 1; i < files.size(); ++i)
    if (files[i].stem() == files[i - 1].stem())
      throw FileError(files[i], "is there in two formats, keep one");
}

}  // namespace

ScanFiles find_scan_files(const fs::path& folder) {
  const Files all = files_in(folder);
  ScanFiles scans;
  std::ranges::copy_if(all, std::back_inserter(scans.files), looks_like_scan);
  if (scans.files.empty())
    std::ranges::copy_if(all, std::back_inserter(scans.files), looks_like_kitti);
  const Files no_files = take_out(scans.files, is_no_file);
  if (!no_files.empty())
    scans.notes.push_back(names_of(no_files) + ": no file, or a link to one that is not there");
  if (std::ranges::any_of(scans.files, is_named_scan)) {
    const Files others = take_out(scans.files, [](const fs::path& f) { return !is_named_scan(f); });
    if (!others.empty())
      scans.notes.push_back(names_of(others) + ": no scan, as others are named scan_...");
  }
  if (scans.files.empty()) refuse(folder, all, scans);
  refuse_two_formats(scans.files);
  return scans;
}

}  // namespace voxlist::io
