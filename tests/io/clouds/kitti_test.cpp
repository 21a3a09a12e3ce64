#include "voxlist/io/clouds/kitti.h"

#include <gmock/gmock.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"
#include "voxlist/io/files/cursor.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/scans/scan_folder.h"

namespace voxlist::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string bytes_of(const std::vector<float>& numbers) {
  std::string bytes(4 * numbers.size(), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

const std::string kTwoPoints = bytes_of({1, 2, 3, 0.5F, -4, 5.5F, -6, 0.25F});

TEST(Kitti, HasPointsAndIntensities) {
  FurtherColumns further;
  const Cloud cloud = parse_kitti(kTwoPoints, &further);
  EXPECT_THAT(cloud.points, ElementsAre(Eigen::Vector3f(1, 2, 3), Eigen::Vector3f(-4, 5.5F, -6)));
  EXPECT_THAT(further.names, ElementsAre("intensity"));
  EXPECT_THAT(further.values[0], ElementsAre(0.5F, 0.25F));
  EXPECT_EQ(parse_kitti(kTwoPoints).points.size(), 2u);
}

TEST(Kitti, RefusesOtherBytes) {
  EXPECT_THROW(parse_kitti(""), FormatError);
  EXPECT_THROW(parse_kitti(kTwoPoints.substr(1)), FormatError);
  EXPECT_THROW(parse_kitti(bytes_of({1, 2, 3e30F, 0})), FormatError);
}

TEST(Kitti, FolderHasTheTimesBesideIt) {
  const test::TemporaryFolder sequence;
  std::filesystem::create_directory(sequence.path() / "velodyne");
  for (const char* name : {"velodyne/000000.bin", "velodyne/000001.bin", "velodyne/000002.bin"})
    sequence.write(name, kTwoPoints);
  sequence.write("times.txt", "0.000000e+00\n1.037e-01\n2.074e-01");
  const ScanFolder folder(sequence.path() / "velodyne");
  ASSERT_EQ(folder.size(), 3u);
  EXPECT_TRUE(folder.has_times());
  EXPECT_EQ(folder.utime_us(1), 103'700);
  EXPECT_EQ(folder.utime_us(2), 207'400);
  EXPECT_EQ(folder.read_raw(1).further.names.size(), 1u);
}

TEST(Kitti, FolderRefusesTimesThatAreTooFewOrNone) {
  for (const char* times : {"0.0\n", "0.0\n0.1\nsoon\n", "-1\n0\n1\n"}) {
    const test::TemporaryFolder folder;
    for (const char* name : {"0.bin", "1.bin", "2.bin"}) folder.write(name, kTwoPoints);
    folder.write("times.txt", times);
    EXPECT_THROW(ScanFolder{folder.path()}, FileError) << times;
  }
}

TEST(Kitti, FilesAreNoScansBesideOthers) {
  const test::TemporaryFolder folder;
  folder.write("a.bin", kTwoPoints);
  folder.write("a_1.ply",
               "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
               "property float z\nend_header\n1 2 3\n");
  EXPECT_EQ(ScanFolder(folder.path()).size(), 1u);
}

}  // namespace
}  // namespace voxlist::io
