// Whether what is left in a map of two days, such as furniture that was moved away, keeps a robot
// from finding itself on the third, when furniture was moved once more: in the map as it is, in
// one that is carved, and in one from which a person has erased what was moved away. Each scan is
// located by itself. Arguments: [--seeds FIRST LAST]; without: seed 1.
#include <cstdio>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "tests/bench/answers.h"
#include "tests/bench/ghosts/ghost_drive.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::bench {
namespace {

mapping::MapBuilder map_of(const std::vector<GhostScan>& scans, bool carve) {
  mapping::MapBuilder builder({.carve = carve});
  for (const GhostScan& scan : scans) builder.add({to_pose3(scan.truth), scan.cloud});
  return builder;
}

void erase(const std::vector<Eigen::AlignedBox3d>& boxes, mapping::MapBuilder& builder) {
  mapping::MapEdits edits;
  for (const Eigen::AlignedBox3d& box : boxes) edits.add(EditKind::kErase, box, builder.poses());
  builder.edit(std::move(edits));
}

void locate_all(const std::vector<GhostScan>& scans, const OccupancyMap& map, Tally& tally) {
  matching::Localiser localiser(map);
  for (const GhostScan& scan : scans) tally.add(localiser.locate(scan.cloud), scan.truth, false);
}

void measure(const GhostDriveConfig& config, std::map<std::string, Tally>& tallies) {
  const std::vector<GhostScan> mapped = ghost_drive(config), asked = next_day(config);
  mapping::MapBuilder builder = map_of(mapped, false);
  locate_all(asked, builder.map(), tallies["nothing goes"]);
  erase(moved_away(config), builder);
  locate_all(asked, builder.map(), tallies["erased by hand"]);
  locate_all(asked, map_of(mapped, true).map(), tallies["voids"]);
}

int run(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const bool has_seeds = arguments.size() == 3 && arguments[0] == "--seeds";
  const int first = has_seeds ? std::stoi(arguments[1]) : 1;
  const int last = has_seeds ? std::stoi(arguments[2]) : 1;
  for (const auto& [laser, name] : {std::pair(GhostLaser::k16Rings, "16 rings"),
                                    std::pair(GhostLaser::kMirror, "mirror scanner")}) {
    std::map<std::string, Tally> tallies;
    for (int seed = first; seed <= last; ++seed) measure({laser, seed}, tallies);
    std::printf("%s, seeds %d to %d\n", name, first, last);
    for (const auto& [map, tally] : tallies) tally.print(map);
    std::fflush(stdout);
    if (!has_seeds) return 0;
  }
  return 0;
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  try {
    return voxlist::bench::run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_next_day: %s\n", e.what());
    return 1;
  }
}
