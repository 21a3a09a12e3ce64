#include "voxlist/io/scans/scan_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/io/scans/scan_files.h"
#include "tests/temporary_folder.h"
#include "voxlist/io/clouds/cloud_file.h"
#include "voxlist/io/files/natural_order.h"

namespace voxlist::io {
namespace {

using test::TemporaryFolder;

void put_scan(const TemporaryFolder& folder, const std::string& name, float x) {
  Cloud cloud;
  cloud.points = {{x, 0.0F, 0.0F}};
  write_ply(folder / name, cloud);
}

std::string error_of(const std::filesystem::path& path) {
  try {
    ScanFolder folder(path);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

TEST(NaturalOrder, SortsNumbersInNamesAsNumbers) {
  EXPECT_TRUE(natural_less("scan_9", "scan_10"));
  EXPECT_FALSE(natural_less("scan_10", "scan_9"));
  EXPECT_TRUE(natural_less("scan_009", "scan_10"));
  EXPECT_TRUE(natural_less("a2b3", "a2b12"));
  EXPECT_TRUE(natural_less("a", "a1"));
  EXPECT_NE(natural_less("a01", "a1"), natural_less("a1", "a01"));
  EXPECT_FALSE(natural_less("a1", "a1"));
}

TEST(ScanFolder, ReadsScansInNaturalOrderOnceASecond) {
  const TemporaryFolder folder;
  put_scan(folder, "scan_10.ply", 10.0F);
  put_scan(folder, "scan_9.ply", 9.0F);
  put_scan(folder, "map.ply", 0.0F);
  folder.write("scan_11.pcd", test::scan_samples()[4].bytes);
  const ScanFolder scans(folder.path());
  ASSERT_EQ(scans.size(), 3U);
  EXPECT_EQ(scans.read(0).points[0].x(), 9.0F);
  EXPECT_EQ(scans.read(1).points[0].x(), 10.0F);
  EXPECT_EQ(scans.read(2).points.size(), 20U);
  EXPECT_EQ(scans.read(2).utime_us, 2'000'000);
  EXPECT_FALSE(scans.truth(0));
  EXPECT_FALSE(scans.odometry());
}

TEST(ScanFolder, TakesTimesInNamesWhereNoTableTellsThem) {
  const TemporaryFolder folder;
  for (const char* name : {"1700000001.5.ply", "1700000001.25.ply", "1700000002.ply"})
    put_scan(folder, name, 1.0F);
  folder.write("odometry.csv", "t,x,y,yaw\n1700000001.3,0,0,0\n");
  const ScanFolder scans(folder.path());
  EXPECT_TRUE(scans.has_times());
  EXPECT_EQ(scans.file_notes(),
            (std::vector<std::string>{"the scans' times are those in their names, in seconds"}));
  EXPECT_EQ(scans.file(0).filename(), "1700000001.25.ply");
  EXPECT_EQ(scans.utime_us(1), 1700000001500000);
  EXPECT_EQ(scans.utime_us(2), 1700000002000000);
  put_scan(folder, "last.ply", 1.0F);  // now one has none
  EXPECT_FALSE(ScanFolder(folder.path()).has_times());
  EXPECT_TRUE(ScanFolder(folder.path()).file_notes().empty());
}

TEST(ScanFolder, MatchesRowsWithTimesInNames) {
  const TemporaryFolder folder;
  for (const char* name :
       {"1403636579763555584.ply", "1403636580763555584.ply", "1403636581763555584.ply"})
    put_scan(folder, name, 1.0F);
  folder.write("poses.csv",
               "#timestamp [ns],p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []\n"
               "1403636579763555584,1,0,0,1,0,0,0\n1403636580100000000,9,0,0,1,0,0,0\n"
               "1403636581763555584,3,0,0,1,0,0,0\n");
  const ScanFolder scans(folder.path());
  EXPECT_EQ(scans.truth(0)->translation().x(), 1.0);
  EXPECT_FALSE(scans.truth(1));
  EXPECT_EQ(scans.truth(2)->translation().x(), 3.0);
  EXPECT_EQ(scans.utime_us(1), 1403636580763555);
}

TEST(ScanFolder, TakesOtherNamesWhenNoneIsScan) {
  const TemporaryFolder folder;
  put_scan(folder, "b.ply", 2.0F);
  put_scan(folder, "a.PLY", 1.0F);
  const ScanFolder scans(folder.path());
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_EQ(scans.read(0).points[0].x(), 1.0F);
}

TEST(ScanFolder, TakesTimesAndTruthByScanNumberAndFillsGaps) {
  const TemporaryFolder folder;
  for (int i = 0; i < 6; ++i) {
    put_scan(folder, "scan_" + std::to_string(i) + ".ply", 0.0F);
  }
  folder.write("poses.csv", "index,t,x,y,yaw\n3,102,3,0,0\n1,100,1,0,0\n");
  folder.write("odometry.csv", "t,x,y,yaw\n99,0,0,0\n");
  const ScanFolder scans(folder.path());
  const std::vector<std::int64_t> seconds{99, 100, 101, 102, 103, 104};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(scans.utime_us(i), seconds[i] * 1'000'000) << i;
  }
  EXPECT_FALSE(scans.truth(2));
  ASSERT_TRUE(scans.truth(3));
  EXPECT_EQ(scans.truth(3)->translation().x(), 3.0);
  EXPECT_EQ(scans.odometry()->rows.size(), 1U);
}

TEST(ScanFolder, MatchesPosesByFileName) {
  const TemporaryFolder folder;
  put_scan(folder, "scan_1.ply", 0.0F);
  put_scan(folder, "scan_2.ply", 0.0F);
  folder.write("poses.csv", "index,file,x,y,yaw\n7,scans/scan_2.pcd,2,0,0\n8,scan_1.ply,1,0,0\n");
  const ScanFolder scans(folder.path());
  EXPECT_EQ(scans.truth(0)->translation().x(), 1.0);
  EXPECT_EQ(scans.truth(1)->translation().x(), 2.0);
}

TEST(ScanFolder, TakesNumbersInNamesWhenTheTableMeansThose) {
  const TemporaryFolder folder;
  put_scan(folder, "scan_100.ply", 0.0F);
  put_scan(folder, "scan_101.ply", 0.0F);
  folder.write("poses.csv", "index,x,y,yaw\n100,1,0,0\n101,2,0,0\n");
  EXPECT_EQ(ScanFolder(folder.path()).truth(1)->translation().x(), 2.0);
}

TEST(ScanFolder, GivesScansTheTimesOfTheirRowsWhenAScanIsMissing) {
  const TemporaryFolder folder;
  for (const int i : {0, 1, 3, 4, 6}) {
    put_scan(folder, "scan_" + std::to_string(i) + ".ply", 0.0F);
  }
  folder.write("poses.csv",
               "index,t,x,y,yaw\n0,0,0,0,0\n1,1,1,0,0\n2,2,2,0,0\n3,3,3,0,0\n6,6,6,0,0\n");
  const ScanFolder scans(folder.path());
  EXPECT_EQ(scans.truth(2)->translation().x(), 3.0);
  EXPECT_FALSE(scans.truth(3));
  EXPECT_EQ(scans.utime_us(3), 4'000'000);
  EXPECT_EQ(scans.utime_us(4), 6'000'000);
  EXPECT_EQ(scans.notes(),
            (std::vector<std::string>{"row 2 has no scan", "scan_4.ply has no row"}));
}

TEST(ScanFolder, LeavesOutHiddenFilesOurOwnMapAndWhatIsNoFile) {
  const TemporaryFolder folder;
  put_scan(folder, "cloud_0.ply", 5.0F);
  put_scan(folder, "map.ply", 0.0F);
  folder.write("._cloud_0.ply", "resources of a Mac");
  folder.write(".scan_3.ply", "");
  std::filesystem::create_directory(folder / "cloud_1.ply");
  const ScanFolder scans(folder.path());
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans.read(0).points[0].x(), 5.0F);
}

TEST(ScanFolder, TellsWhatLooksLikeAScanAndIsNone) {
  const TemporaryFolder folder;
  put_scan(folder, "scan_0.ply", 0.0F);
  put_scan(folder, "whole_room.ply", 0.0F);
  std::filesystem::create_symlink("nowhere", folder / "scan_1.ply");
  std::filesystem::create_symlink("scan_2.ply", folder / "scan_2.ply");
  std::filesystem::create_directory(folder / "scan_3.ply");
  const ScanFolder scans(folder.path());
  EXPECT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans.file_notes(),
            (std::vector<std::string>{
                "scan_1.ply, scan_2.ply, scan_3.ply: no file, or a link to one that is not there",
                "whole_room.ply: no scan, as others are named scan_..."}));
}

TEST(ScanFolder, SaysWhatAFolderWithoutScansHolds) {
  const TemporaryFolder folder;
  folder.write("scan_0.ply.gz", "");
  folder.write("scan_1.ply.gz", "");
  folder.write("notes", "");
  EXPECT_NE(error_of(folder.path()).find("it holds 1 without an ending, 2 .gz"), std::string::npos)
      << error_of(folder.path());
}

TEST(ScanFolder, SaysThatTwoScansHaveOneTime) {
  const TemporaryFolder folder;
  for (const char* name : {"scan_0.ply", "scan_1.ply", "scan_2.ply"}) put_scan(folder, name, 0.0F);
  folder.write("poses.csv", "t,x,y,yaw\n1,0,0,0\n1,0,0,0\n2,0,0,0\n");
  EXPECT_NE(error_of(folder.path()).find("gives scan_0.ply and scan_1.ply the same time"),
            std::string::npos);
}

TEST(ScanFolder, TakesPosesInTheFormsOfOthers) {
  const TemporaryFolder folder;
  for (int i = 0; i < 3; ++i) put_scan(folder, "scan_" + std::to_string(i) + ".ply", 0.0F);
  folder.write("poses.csv",
               "# timestamp tx ty tz qx qy qz qw\n1604644894.0 0 0 0 0 0 0 1\n"
               "1604644895.0 0.4 0 0 0 0 0 1\n");
  const ScanFolder scans(folder.path());
  EXPECT_EQ(scans.utime_us(2), 1604644896'000000);
  EXPECT_EQ(scans.truth(1)->translation().x(), 0.4);
  EXPECT_FALSE(scans.truth(2));
}

TEST(ScanFolder, SaysThatTimesAreInAnotherUnit) {
  const TemporaryFolder folder;
  put_scan(folder, "scan_0.ply", 0.0F);
  put_scan(folder, "scan_1.ply", 0.0F);
  folder.write("poses.csv", "index,utime,x,y,yaw\n0,1700000000,0,0,0\n1,1700000001,0,0,0\n");
  EXPECT_NE(error_of(folder.path()).find("1 us apart: are its times in seconds"),
            std::string::npos);
  folder.write("poses.csv", "index,utime,x,y,yaw\n0,0,0,0,0\n1,0,0,0,0\n");
  EXPECT_NE(error_of(folder.path()).find("all scans the same time"), std::string::npos);
}

TEST(ScanFolder, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  EXPECT_NE(error_of(folder / "none").find("no folder"), std::string::npos);
  EXPECT_NE(error_of(folder.path()).find("has no scans"), std::string::npos);
  put_scan(folder, "scan_0.ply", 0.0F);
  put_scan(folder, "scan_1.ply", 0.0F);
  folder.write("poses.csv", "index,x,y,yaw\n7,0,0,0\n");
  EXPECT_NE(error_of(folder.path()).find("matches none"), std::string::npos);
  folder.write("poses.csv", "index,t,x,y,yaw\n0,5,0,0,0\n1,4,0,0,0\n");
  EXPECT_NE(error_of(folder.path()).find("puts scan_1.ply before scan_0.ply"), std::string::npos);
  folder.write("poses.csv", "index,x,y,yaw\n0,0,0,0\n");
  folder.write("scan_1.pcd", "");
  EXPECT_NE(error_of(folder.path()).find("two formats"), std::string::npos);
}

TEST(ScanFolder, ReadsTheHall) {
  const char* given = std::getenv("VOXLIST_DATA");
  const std::filesystem::path data = given ? given : VOXLIST_SOURCE_DIR "/../shared/data";
  if (!std::filesystem::exists(data / "hall")) {
    GTEST_SKIP() << "no real scans at " << data / "hall"
                 << "; set VOXLIST_DATA to their folder";
  }
  const ScanFolder hall(data / "hall");
  ASSERT_EQ(hall.size(), 89U);
  EXPECT_EQ(hall.utime_us(0), 1630577758569000);
  EXPECT_TRUE(hall.truth(88));
  EXPECT_EQ(hall.read(88).points.size(), 12000U);
}

}  // namespace
}  // namespace voxlist::io
