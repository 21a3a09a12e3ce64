#include "voxlist/io/files/time_in_name.h"

#include <gtest/gtest.h>

#include <string>

namespace voxlist::io {
namespace {

struct Name {
  const char* file;
  std::int64_t utime_us;
  TimeUnit unit;
};

TEST(TimeInName, IsReadInEveryUnit) {
  for (const Name& told : {
           Name{"1403636579763555584.pcd", 1403636579763555, TimeUnit::kNanoseconds},
           Name{"1403636579763555.pcd", 1403636579763555, TimeUnit::kMicroseconds},
           Name{"1403636579763.pcd", 1403636579763000, TimeUnit::kMilliseconds},
           Name{"1403636579.ply", 1403636579000000, TimeUnit::kSeconds},
           Name{"1700000001.25.ply", 1700000001250000, TimeUnit::kSeconds},
           Name{"1700000001.250000000.pcd", 1700000001250000, TimeUnit::kSeconds},
           Name{"a/b/scan_1700000001.25.ply", 1700000001250000, TimeUnit::kSeconds},
           Name{"os1_cloud_1700000001_000000123.pcd", 1700000001000000, TimeUnit::kSeconds},
           Name{"1700000001-250000.pcd", 1700000001250000, TimeUnit::kSeconds},
           Name{"velodyne2_1403636579763555584.pcd", 1403636579763555, TimeUnit::kNanoseconds},
           Name{"12.5.ply", 12500000, TimeUnit::kSeconds},
           Name{"0.000000.ply", 0, TimeUnit::kSeconds},
       }) {
    const auto time = time_in_name(told.file);
    ASSERT_TRUE(time) << told.file;
    EXPECT_EQ(time->utime_us, told.utime_us) << told.file;
    EXPECT_EQ(time->unit, told.unit) << told.file;
  }
}

TEST(TimeInName, IsNoNumberOfAScan) {
  for (const char* file :
       {"scan_000.ply", "000123.pcd", "0000000012.pcd", "scan.ply", "scan_1.5.ply",
        "a_20231105_142530.ply", "20231105142530.ply", "99999999999999999999999.ply",
        "1700000001_7.ply", ".25.ply", "1..ply", "1700000001.2.3.ply"})
    EXPECT_FALSE(time_in_name(file)) << file;
}

}  // namespace
}  // namespace voxlist::io
