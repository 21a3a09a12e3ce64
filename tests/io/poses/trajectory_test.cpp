#include "voxlist/io/poses/trajectory.h"

#include <gtest/gtest.h>

#include "tests/io/scans/scan_files.h"
#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"

namespace voxlist::io {
namespace {

using test::TemporaryFolder;

TEST(Trajectory, ComesBackAsItWasWritten) {
  const test::TemporaryFolder folder;
  std::vector<StampedPose3> written{{1630577758569001, to_pose3({1.25, -2.5, 3.0})},
                                    {-1'500'000, to_pose3({0.0, 0.0, -0.1})}};
  written[0].pose.translation().z() = 0.125;
  write_tum(folder / "t.tum", written);
  const auto back = read_tum(folder / "t.tum");
  ASSERT_EQ(back.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back[i].utime_us, written[i].utime_us);
    EXPECT_TRUE(back[i].pose.isApprox(written[i].pose, 1e-8));
  }
  EXPECT_NE(read_file(folder / "t.tum").find("\n1630577758.569001 1.250000000 -2.5"),
            std::string::npos);
}

TEST(Trajectory, SkipsCommentsAndNamesTheLineOfAnError) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("t.tum", "# t x y z\r\n\r\n1.5 1 2 3 0 0 0 1\r\n");
  EXPECT_EQ(read_tum(path).at(0).utime_us, 1'500'000);
  for (const std::string line : {"1 2 3", "1 0 0 0 0 0 0 2", "1 0 0 nan 0 0 0 1",
                                 "1 0 0 0 0 0 0 1 9", "1e18 0 0 0 0 0 0 1"}) {
    folder.write("t.tum", "# c\n" + line + "\n");
    try {
      read_tum(path);
      ADD_FAILURE() << line;
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("line 2"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace voxlist::io
