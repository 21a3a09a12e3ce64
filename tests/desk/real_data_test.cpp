#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/desk/scan_set.h"
#include "voxlist/evaluation/evaluation.h"
#include "voxlist/io/poses/trajectory.h"

namespace voxlist::desk {
namespace {

// Recordings that the project does not carry: $VOXLIST_DATA, else beside the sources.
std::string data_folder() {
  const char* folder = std::getenv("VOXLIST_DATA");
  return folder != nullptr ? folder : VOXLIST_SOURCE_DIR "/../shared/data";
}

// Takes a minute, and several with sanitizers.
TEST(RealData, TheHallIsMappedWholeAndWithinTenCentimetres) {
  const std::string hall = data_folder() + "/hall";
  if (!std::filesystem::exists(hall)) GTEST_SKIP() << hall << " is not there: set VOXLIST_DATA";
  const test::WorkFolder work;
  ASSERT_EQ(test::run({"import", hall, "-o", work / "log"}).exit_code, 0);
  ASSERT_EQ(
      test::run({"map", work / "log", "-o", work / "map", "--octomap-resolution", "1"}).exit_code,
      0);
  const auto errors = evaluation::evaluate(io::read_tum(work / "map/trajectory.tum"),
                                           io::read_pose_csv(hall + "/poses.csv"));
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->matched, 89u);
  EXPECT_EQ(errors->in_truth, 89u);
  EXPECT_LE(errors->anchored_m.rmse, 0.10);
  EXPECT_LE(errors->end_position_m, 0.10);
}

}  // namespace
}  // namespace voxlist::desk
