#include "services/voxlist/maps/summary.h"

#include <fmt/core.h>

#include <system_error>

#include "voxlist/io/files/file.h"
#include "voxlist/mapping/map_store.h"
#include "voxlist/system/version.h"

namespace voxlist::desk {
namespace {

// Keys that count what each run did.
constexpr auto kCounts = {"scans",    "placed",  "lost",           "ambiguous",
                          "pieces",   "loops",   "in_pieces",      "without_pose",
                          "left_out", "seconds", "elapsed_seconds"};

void set_factor(Summary& summary) {
  const double elapsed_s = summary["elapsed_seconds"].get<double>();
  summary["real_time_factor"] =
      elapsed_s > 0.0 ? summary["seconds"].get<double>() / elapsed_s : 0.0;
}

// What is not there, or is no number, counts as none.
Summary sum(const Summary& a, const Summary& b, const std::string& key) {
  const auto is_number = a.contains(key) && a[key].is_number();
  if (!is_number) return b[key];
  if (b[key].is_number_integer()) return a[key].get<std::int64_t>() + b[key].get<std::int64_t>();
  return a[key].get<double>() + b[key].get<double>();
}

}  // namespace

Summary summary_of(const RunFigures& figures) {
  const Eigen::Vector3d& offset_m = figures.offset_m;
  Summary summary = {
      {"input", figures.input},
      {"version", version()},
      {"scans", figures.scans},
      {"placed", figures.placed},
      {"lost", figures.lost},
      {"ambiguous", figures.ambiguous},
      {"pieces", figures.pieces},
      {"in_pieces", figures.in_pieces},
      {"without_pose", figures.without_pose},
      {"left_out", figures.left_out},
      {"loops", figures.loops},
      {"loops_moved_m", figures.loops_moved_m},
      {"offset_m", {offset_m.x(), offset_m.y(), offset_m.z()}},
      {"seconds", figures.seconds},
      {"elapsed_seconds", figures.elapsed_seconds},
      {"interrupted", figures.interrupted},
  };
  set_factor(summary);
  return summary;
}

Summary extended(Summary summary, const RunFigures& figures) {
  const Summary added = summary_of(figures);
  for (const std::string key : kCounts) summary[key] = sum(summary, added, key);
  set_factor(summary);
  summary["interrupted"] = figures.interrupted;
  if (!summary["extended_by"].is_array()) summary["extended_by"] = Summary::array();
  summary["extended_by"].push_back(figures.input);
  return summary;
}

void describe(const VoxelMap& map, std::size_t keyframes, Summary& summary) {
  summary["version"] = version();
  summary["keyframes"] = keyframes;
  summary["map_hash"] = hash_text(map);
  summary["voxels"] = map.size();
  summary["resolution_m"] = map.resolution_m();
}

std::optional<Summary> read_summary(const std::filesystem::path& folder) try {
  Summary summary = Summary::parse(io::read_file(folder / "summary.json"), nullptr, false);
  return summary.is_object() ? std::optional(std::move(summary)) : std::nullopt;
} catch (const io::FileError&) {
  return std::nullopt;
}

bool is_of_one_run(const std::filesystem::path& folder) {
  const auto summary = read_summary(folder);
  if (!summary || summary->value("input", std::string()).empty()) return false;
  if (summary->contains("extended_by")) return false;
  std::error_code failure;
  const std::uintmax_t bytes = std::filesystem::file_size(folder / mapping::kKeyframeFile, failure);
  return !failure && summary->value("keyframe_bytes", bytes) == bytes;
}

std::string hash_text(const VoxelMap& map) { return fmt::format("{:016x}", map.hash()); }

}  // namespace voxlist::desk
