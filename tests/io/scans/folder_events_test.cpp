#include "voxlist/io/scans/folder_events.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "tests/io/scans/scan_files.h"
#include "tests/temporary_folder.h"
#include "voxlist/io/clouds/cloud_file.h"
#include "voxlist/io/files/file.h"

namespace voxlist::io {
namespace {

using test::TemporaryFolder;

class FolderEvents : public testing::Test {
 protected:
  FolderEvents() {
    Cloud cloud;
    cloud.points = {{1.0F, 0.0F, 0.0F}};
    for (const char* name : {"scan_0.ply", "scan_1.ply"}) write_ply(folder_ / name, cloud);
    folder_.write("poses.csv", "index,t,x,y,yaw\n0,10,0,0,0\n1,11,1,0,0\n");
  }

  // "s0" for scan 0, "o2" for row 2 of odometry.
  std::string events() const {
    std::ostringstream text;
    for (const FolderEvent& event : events_of(ScanFolder(folder_.path())))
      text << (event.is_scan ? 's' : 'o') << event.number << ' ';
    return text.str();
  }

  const test::TemporaryFolder folder_;
};

TEST_F(FolderEvents, PutOdometryBeforeTheScanOfTheSameTime) {
  folder_.write("odometry.csv", "t,x,y,yaw\n9.5,0,0,0\n10,0,0,0\n10.5,0,0,0\n11,0,0,0\n");
  EXPECT_EQ(events(), "o0 o1 s0 o2 o3 s1 ");
}

TEST_F(FolderEvents, LeaveOutOdometryFarFromTheScans) {
  folder_.write("odometry.csv", "t,x,y,yaw\n8.9,0,0,0\n10.5,0,0,0\n12.1,0,0,0\n");
  EXPECT_EQ(events(), "s0 o1 s1 ");
}

TEST_F(FolderEvents, RefuseOdometryOfAnotherTime) {
  folder_.write("odometry.csv", "t,x,y,yaw\n1000,0,0,0\n");
  EXPECT_THROW(events(), FileError);
}

}  // namespace
}  // namespace voxlist::io
