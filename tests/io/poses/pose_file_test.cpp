#include "voxlist/io/poses/pose_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/io/scans/scan_files.h"
#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"

namespace voxlist::io {
namespace {

using test::TemporaryFolder;

PoseTable read(const std::string& text) {
  const TemporaryFolder folder;
  return read_pose_csv(folder.write("poses.csv", text));
}

std::string error_of(const std::string& text) {
  try {
    read(text);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

void expect_pose(const PoseRow& row, double x, double y, double z, double yaw) {
  EXPECT_TRUE(row.pose.translation().isApprox(Eigen::Vector3d(x, y, z)));
  EXPECT_NEAR(to_pose2(row.pose).yaw_rad, yaw, 1e-12);
}

TEST(PoseFile, ReadsColumnsWithUnits) {
  const auto table = read("index,utime,x_m,y_m,yaw_rad\n3,1630577758569000,1,2,0.5\n");
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0].scan, 3);
  EXPECT_EQ(table.rows[0].utime_us, 1630577758569000);
  expect_pose(table.rows[0], 1.0, 2.0, 0.0, 0.5);
  EXPECT_TRUE(table.has_scans && table.has_times);
  EXPECT_FALSE(table.has_files || table.has_heights);
}

TEST(PoseFile, ToleratesHowOthersWriteTables) {
  const auto table = read(
      "\xEF\xBB\xBF# \"Scan\" ; T [s] ; X (m) ; \"Y\" ; Z ; YAW_DEG ; comment\r\n"
      "\r\n# a remark\r\n 7 ; 1630577758.569001 ; \"1.5\" ; +2 ; 3 ; 90 ; \"a;b\"\r\n");
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0].scan, 7);
  EXPECT_EQ(table.rows[0].utime_us, 1630577758569001);
  expect_pose(table.rows[0], 1.5, 2.0, 3.0, M_PI / 2.0);
  EXPECT_TRUE(table.has_heights);
}

TEST(PoseFile, ReadsQuaternionsAndRollPitchYawAlike) {
  const auto quaternion = read("x,y,z,qx,qy,qz,qw\n0,0,0,0.5,0.5,0.5,0.5\n");
  const auto angles = read("x,y,yaw,roll,pitch\n0,0,1.5707963267948966,1.5707963267948966,0\n");
  EXPECT_TRUE(quaternion.rows[0].pose.isApprox(angles.rows[0].pose, 1e-12));
}

TEST(PoseFile, KnowsTheNamesOfOthers) {
  for (const std::string header :
       {"timestamp tx ty tz qx qy qz qw", "t,p_x [m],p_y [m],p_z [m],q_x,q_y,q_z,q_w",
        "t,position_x,position_y,position_z,orientation_x,orientation_y,orientation_z,orientation_"
        "w",
        "t,pos_x,pos_y,pos_z,quat_x,quat_y,quat_z,quat_w"}) {
    std::string table = header;
    std::ranges::replace(table, ' ', header.find(',') == std::string::npos ? ',' : ' ');
    expect_pose(read(table + "\n0.5,1,2,3,0,0,0,1\n").rows[0], 1, 2, 3, 0);
  }
}

TEST(PoseFile, ReadsDecimalCommasWhereCommasSeparateNothing) {
  expect_pose(read("t;x;y;z;yaw\n0,5;1,25;-2,5;3.5;0,25\n").rows[0], 1.25, -2.5, 3.5, 0.25);
  EXPECT_NE(error_of("t;x;y;yaw\n0;1.234,5;2;0\n").find("column x"), std::string::npos);
}

TEST(PoseFile, AsksAboutAYawOfManyTurns) {
  EXPECT_EQ(read("x,y,yaw\n0,0,270\n").notes.size(), 1U);
  EXPECT_TRUE(read("x,y,yaw\n0,0,-3.2\n").notes.empty());
  EXPECT_TRUE(read("x,y,yaw_deg\n0,0,270\n").notes.empty());
}

TEST(PoseFile, MendsAQuaternionWithinOnePercentOnly) {
  const auto table = read("x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,1.009\n");
  EXPECT_TRUE(table.rows[0].pose.isApprox(Pose3::Identity(), 1e-12));
  EXPECT_NE(error_of("x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,1.02\n").find("line 2: columns qx"),
            std::string::npos);
}

TEST(PoseFile, WithoutTimesScansComeOnceASecond) {
  const auto table = read("index,x,y,yaw\n4,0,0,0\n9,0,0,0\n");
  EXPECT_EQ(table.rows[1].utime_us, 9'000'000);
  EXPECT_FALSE(table.has_times);
}

TEST(PoseFile, TakesScanNumbersFromFileNamesOrRows) {
  const auto named = read("file,x,y,yaw\nrun2/scan_012.ply,0,0,0\nother.ply,1,0,0\n");
  EXPECT_EQ(named.rows[0].scan, 12);
  EXPECT_EQ(named.rows[1].scan, 1);
  EXPECT_EQ(number_in_name("1630577758569000.ply"), std::nullopt);
  const auto in_scan = read("scan,x,y,yaw\nscan_5.pcd,0,0,0\n");
  EXPECT_EQ(in_scan.rows[0].file, "scan_5.pcd");
  EXPECT_EQ(in_scan.rows[0].scan, 5);
}

TEST(PoseFile, ErrorsNameLineAndColumn) {
  EXPECT_NE(error_of("index,x,y,yaw\n0,0,0,0\n1,0,oops,0\n").find("line 3: column y: \"oops\""),
            std::string::npos);
  EXPECT_NE(error_of("index,x,y,yaw\n0,0,nan,0\n").find("line 2: column y"), std::string::npos);
  EXPECT_NE(error_of("index,x,y,yaw\n0,0,0\n").find("line 2: column yaw"), std::string::npos);
  EXPECT_NE(error_of("index,x,y,yaw\n0.5,0,0,0\n").find("column index"), std::string::npos);
  EXPECT_NE(error_of("index,x,y,yaw\nnan,0,0,0\n").find("column index"), std::string::npos);
  EXPECT_NE(error_of("timestamp,x,y,yaw\n1403636579763555584,0,0,0\n").find("no time in this unit"),
            std::string::npos);
}

TEST(PoseFile, RefusesDuplicatesMissingColumnsAndEmptyTables) {
  EXPECT_NE(error_of("index,x,y,yaw\n1,0,0,0\n1,0,0,0\n").find("comes twice"), std::string::npos);
  EXPECT_NE(error_of("file,x,y,yaw\na,0,0,0\na,0,0,0\n").find("comes twice"), std::string::npos);
  EXPECT_NE(error_of("index,x,y\n1,0,0\n").find("but has index, x, y"), std::string::npos);
  EXPECT_NE(error_of("index,x,y,yaw\n").find("has no poses"), std::string::npos);
  EXPECT_NE(error_of("").find("is empty"), std::string::npos);
}

TEST(PoseFile, OdometryNeedsTimesThatGoOn) {
  const TemporaryFolder folder;
  const auto path = folder.write("odometry.csv", "t,x,y,yaw\n1.0,0,0,0\n1.05,1,0,0\n");
  EXPECT_EQ(read_odometry_csv(path).rows[1].utime_us, 1'050'000);
  folder.write("odometry.csv", "x,y,yaw\n0,0,0\n");
  EXPECT_THROW(read_odometry_csv(path), FileError);
  folder.write("odometry.csv", "t,x,y,yaw\n1.0,0,0,0\n0.9,1,0,0\n");
  EXPECT_THROW(read_odometry_csv(path), FileError);
}

}  // namespace
}  // namespace voxlist::io
