#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/poses/pose_file.h"
#include "voxlist/io/poses/trajectory.h"

namespace voxlist::io {
namespace {

class NumberRows : public testing::Test {
 protected:
  PoseTable read(const std::string& text) { return read_poses(folder_.write("poses.txt", text)); }

  // The only pose must be at (1, 2, 3), turned by a quarter to the left.
  void expect_pose(const std::string& text, std::int64_t utime_us) {
    const PoseTable table = read(text);
    ASSERT_EQ(table.rows.size(), 1U) << text;
    EXPECT_EQ(table.rows[0].utime_us, utime_us) << text;
    Pose3 expected = to_pose3({1.0, 2.0, M_PI / 2.0});
    expected.translation().z() = 3.0;
    EXPECT_TRUE(table.rows[0].pose.isApprox(expected, 1e-3)) << text;
    EXPECT_TRUE(table.has_heights);
  }

  std::string error(const std::string& text) {
    try {
      read(text);
    } catch (const FileError& problem) {
      return problem.what();
    }
    return "no error";
  }

  const test::TemporaryFolder folder_;
};

TEST_F(NumberRows, OfTumAreReadWithAnyHeader) {
  const std::string row = "1604644894.25 1 2 3 0 0 0.70711 0.70711\n";
  for (const std::string header :
       {"", "# timestamp tx ty tz qx qy qz qw\n", "timestamp tx ty tz qx qy qz qw\n", "# a, b\n\n"})
    expect_pose(header + row, 1604644894250000);
  expect_pose("1604644894.25,1,2,3,0,0,0.70711,0.70711\n", 1604644894250000);
}

TEST_F(NumberRows, OfKittiAreMatrices) {
  expect_pose("0 -1 0 1 1 0 0 2 0 0 1 3\n", 0);
  expect_pose("0 -1 0 1 1 0 0 2 0 0 1 3 0 0 0 1\n", 0);
  EXPECT_FALSE(read("1 0 0 0 0 1 0 0 0 0 1 0\n").has_times);
  EXPECT_NE(error("2 0 0 0 0 1 0 0 0 0 1 0\n").find("line 1: the matrix is no rotation"),
            std::string::npos);
}

TEST_F(NumberRows, OfEurocHaveNanosecondsAndWFirst) {
  const std::string row = "1403636579763555584,1,2,3,0.70711,0,0,0.70711,9,9,9\n";
  const std::string header =
      "timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z [], v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1]\n";
  for (const std::string& start : {std::string(), header, "#" + header})
    expect_pose(start + row, 1403636579763556);
}

TEST_F(NumberRows, BelowAHeaderBetweenCommasMeanWhatItSays) {
  expect_pose("# t_ns,x,y,z,qx,qy,qz,qw\n1403636579000000000,1,2,3,0,0,0.70711,0.70711\n",
              1403636579000000);
}

TEST_F(NumberRows, OfNanOrInfAreUnknownPosesAndKeepTheNumbersOfTheOthers) {
  const PoseTable kitti = read(
      "1 0 0 0 0 1 0 0 0 0 1 0\n"
      "-inf -inf -inf -inf -inf -inf -inf -inf -inf -inf -inf -inf\n"
      "1 0 0 5 0 1 0 0 0 0 1 0\n");
  ASSERT_EQ(kitti.rows.size(), 2U);
  EXPECT_EQ(kitti.rows[1].scan, 2);
  EXPECT_EQ(kitti.unknown, 1U);
  EXPECT_EQ(read("1 nan nan nan nan nan nan nan\n2 0 0 0 0 0 0 1\n").rows[0].scan, 1);
  EXPECT_EQ(read("index,x,y,yaw\n0,-inf,-inf,-inf\n1,0,0,0\n").unknown, 1U);
  EXPECT_NE(error("1 0 0 nan 0 0 0 1\n").find("line 1: a number is not finite"), std::string::npos);
  EXPECT_NE(error("1 nan nan nan 0 0 0 1\n").find("no pose that is known"), std::string::npos);
}

TEST_F(NumberRows, ThatAreWrongAreNamedByTheirLine) {
  EXPECT_NE(error("1 0 0 0 0 0 0 1\n\n2 0 0 0 0 0 1\n").find("line 3: 7 numbers instead of 8"),
            std::string::npos);
  EXPECT_NE(error("1604644894000000000 0 0 0 0 0 0 1\n").find("is it in nanoseconds?"),
            std::string::npos);
  EXPECT_NE(error("# nothing\n").find("has no poses"), std::string::npos);
  EXPECT_NE(error("index,x,y,yaw\n0,0,0,0,7\n").find("line 2: 5 cells instead of 4"),
            std::string::npos);
}

TEST_F(NumberRows, OfOurOwnTrajectoryComeBackAtTheLimitsOfTime) {
  const std::vector<StampedPose3> written{{0, Pose3::Identity()},
                                          {8'999'999'999'999'999, Pose3::Identity()}};
  write_tum(folder_ / "trajectory.tum", written);
  const auto back = trajectory_of(read_poses(folder_ / "trajectory.tum"));
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[0].utime_us, 0);
  EXPECT_NEAR(static_cast<double>(back[1].utime_us), 9e15, 2.0);
}

TEST_F(NumberRows, OfAnotherLengthAreRefusedWithTheirNumber) {
  try {
    read("# t x y z qx qy qz\n1 2 3 4 0 0 1\n");
    ADD_FAILURE() << "not refused";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("line 2 has 7 numbers"), std::string::npos);
  }
}

TEST_F(NumberRows, WithoutXAndYAreUnknown) {
  const PoseTable table = read("1 nan nan 0 0 0 0 1\n2 1 2 0 0 0 0 1\n3 -inf inf 0 nan 0 0 1\n");
  EXPECT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.unknown, 2U);
}

}  // namespace
}  // namespace voxlist::io
