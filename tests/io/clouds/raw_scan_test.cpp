#include "voxlist/io/clouds/raw_scan.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "tests/temporary_folder.h"
#include "voxlist/io/clouds/cloud_file.h"

namespace voxlist::io {
namespace {

using testing::ElementsAre;

RawScan read(const std::string& name, const std::string& text) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / name;
  std::ofstream(path, std::ios::binary) << text;
  EXPECT_TRUE(read_cloud_file(path).points.size() <= 3u);
  return read_raw_scan(path);
}

template <class T>
std::string bytes_of(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

TEST(RawScan, HasTheFurtherColumnsOfAPlyFile) {
  const RawScan scan = read("a.ply",
                            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                            "property float intensity\nproperty float y\nproperty float z\n"
                            "property list uchar int echoes\nproperty uint t\nend_header\n"
                            "1 0.5 2 3 2 7 7 0\nnan 0.25 nan nan 0 50\n4 0.125 5 6 1 9 100\n");
  ASSERT_EQ(scan.cloud.points.size(), 3u) << "points that are not finite keep their row";
  EXPECT_EQ(scan.cloud.points[2], Eigen::Vector3f(4, 5, 6));
  EXPECT_TRUE(std::isnan(scan.cloud.points[1].x()));
  EXPECT_THAT(scan.further.names, ElementsAre("intensity", "t"));
  EXPECT_THAT(scan.further.values[0], ElementsAre(0.5F, 0.25F, 0.125F));
  EXPECT_THAT(scan.further.values[1], ElementsAre(0.0F, 50.0F, 100.0F));
}

TEST(RawScan, CountsTimesSince1970FromTheFirst) {
  std::string text =
      "# .PCD v0.7\nFIELDS x y z _ ring timestamp histogram\nSIZE 4 4 4 1 2 8 4\n"
      "TYPE F F F U U F F\nCOUNT 1 1 1 4 1 1 2\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA binary\n";
  for (int i = 0; i < 2; ++i) {
    for (const float v : {1.0F, 2.0F, 3.0F}) text += bytes_of(v);
    text += std::string(4, '\0') + bytes_of(static_cast<std::uint16_t>(15 - i));
    text += bytes_of(1'700'000'000.25 + 0.0625 * i) + std::string(8, '\0');
  }
  const RawScan scan = read("a.pcd", text);
  EXPECT_THAT(scan.further.names, ElementsAre("ring", "timestamp"));
  EXPECT_THAT(scan.further.values[0], ElementsAre(15.0F, 14.0F));
  EXPECT_THAT(scan.further.values[1], ElementsAre(0.0F, 0.0625F));
}

TEST(RawScan, KeepsSmallTimesOfEightBytesAsTheyAre) {
  const RawScan scan = read("a.pcd",
                            "# .PCD v0.7\nFIELDS x y z time\nSIZE 4 4 4 8\nTYPE F F F F\n"
                            "COUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n"
                            "1 2 3 -0.125\n1 2 3 0\n");
  EXPECT_THAT(scan.further.values[0], ElementsAre(-0.125F, 0.0F));
}

TEST(RawScan, KeepsOriginsAsOrigins) {
  const RawScan scan = read("a.ply",
                            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                            "property float y\nproperty float z\nproperty float origin_x\n"
                            "property float origin_y\nproperty float origin_z\nend_header\n"
                            "1 2 3 4 5 6\n");
  EXPECT_TRUE(scan.further.names.empty());
  ASSERT_EQ(scan.cloud.origins.size(), 1u);
  EXPECT_EQ(scan.cloud.origins[0], Eigen::Vector3f(4, 5, 6));
}

}  // namespace
}  // namespace voxlist::io
