#include "voxlist/scanner/sweep/assembly_counts.h"

namespace voxlist::scanner {
namespace {

// Each list in the order of its enum.
constexpr std::array<const char*, kLineFates> kLineNames{
    "assembled",     "dead_side",   "mirror_lost",  "mirror_unknown",    "missing",
    "no_mirror_yet", "no_odometry", "out_of_order", "time_started_anew", "too_many_waiting"};
constexpr std::array<const char*, kBeamFates> kBeamNames{
    "points",        "off_mirror", "blind",   "no_measurement", "no_return",
    "before_mirror", "too_near",   "too_far", "robot"};
constexpr std::array<const char*, kSweepLosses> kSweepNames{"too_few_lines", "mirror_lost",
                                                            "odometry_lost", "too_long"};

template <std::size_t n>
void add_named(const char* kind, const std::array<const char*, n>& names,
               const std::array<std::int64_t, n>& counts,
               std::map<std::string, std::int64_t>& all) {
  for (std::size_t i = 0; i < n; ++i)
    if (counts[i] != 0) all[std::string(kind) + names[i]] = counts[i];
}

}  // namespace

bool has_used_line(const AssemblyCounts& counts) {
  return counts[LineFate::kAssembled] > 0 || counts[LineFate::kDeadSide] > 0;
}

std::optional<LineFate> unused_line(const AssemblyCounts& counts) {
  for (std::size_t i = kLineFates; i-- > 0;) {
    const auto fate = static_cast<LineFate>(i);
    const bool used = fate == LineFate::kAssembled || fate == LineFate::kDeadSide;
    if (!used && counts[fate] > 0) return fate;
  }
  return std::nullopt;
}

std::string counter_name(LineFate fate) {
  return std::string("LASER/") + kLineNames[static_cast<std::size_t>(fate)];
}

std::map<std::string, std::int64_t> by_counter_name(const AssemblyCounts& counts) {
  std::map<std::string, std::int64_t> all;
  add_named("LASER/", kLineNames, counts.lines, all);
  add_named("beams/", kBeamNames, counts.beams, all);
  add_named("CLOUD/", kSweepNames, counts.sweeps, all);
  return all;
}

}  // namespace voxlist::scanner
