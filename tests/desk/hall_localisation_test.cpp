#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "voxlist/io/scans/scan_folder.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::desk {
namespace {

// A recording that the project does not carry: $VOXLIST_DATA, else beside the sources.
std::filesystem::path hall_folder() {
  const char* data = std::getenv("VOXLIST_DATA");
  return std::filesystem::path(data ? data : VOXLIST_SOURCE_DIR "/../shared/data") / "hall";
}

OccupancyMap map_of_even_scans(const io::ScanFolder& scans) {
  OccupancyMap map;
  for (std::size_t i = 0; i < scans.size(); i += 2)
    if (const auto truth = scans.truth(i)) add_scan(scans.read(i), *truth, 100.0, map);
  return map;
}

TEST(HallLocalisation, FindsOddScansInAMapOfEvenOnesWithoutAGuess) {
  if (!std::filesystem::exists(hall_folder()))
    GTEST_SKIP() << hall_folder() << " is not there: set VOXLIST_DATA";
  const io::ScanFolder scans(hall_folder());
  const OccupancyMap map = map_of_even_scans(scans);
  matching::Localiser localiser(map);
  int queries = 0, right = 0, sure = 0;
  double worst_m = 0.0;
  for (std::size_t i = 1; i < scans.size(); i += 2) {
    const auto truth = scans.truth(i);
    if (!truth) continue;
    const matching::Localisation found = localiser.locate(scans.read(i));
    ++queries;
    if (found.modes.empty()) continue;
    const Pose2& pose = found.modes.front().T_map_base;
    const double error_m = distance_m(pose, to_pose2(*truth));
    const bool is_right =
        error_m < 0.10 && turn_rad(pose, to_pose2(*truth)) < std::numbers::pi / 180.0;
    right += is_right;
    sure += found.tracking();
    if (is_right) worst_m = std::max(worst_m, error_m);
    EXPECT_TRUE(is_right || !found.tracking()) << "scan " << i << " is off by " << error_m << " m";
  }
  std::printf("%d of %d right, by %.3f m at most, %d sure\n", right, queries, worst_m, sure);
  EXPECT_GE(queries, 40);
  EXPECT_GE(right, 0.95 * queries);
  EXPECT_GE(sure, 0.9 * queries);
}

}  // namespace
}  // namespace voxlist::desk
