#include <gtest/gtest.h>

#include <map>

#include "tests/io/files/damage.h"
#include "tests/io/scans/scan_files.h"
#include "tests/temporary_folder.h"
#include "voxlist/io/clouds/cloud_file.h"
#include "voxlist/io/poses/pose_file.h"
#include "voxlist/io/poses/trajectory.h"

namespace voxlist::io {
namespace {

using test::TemporaryFolder;

TEST(DamagedScans, AreReadOrRefusedAndAllCounted) {
  constexpr int kFiles = 10'000;
  constexpr std::uint64_t kSeed = 20240229;
  RecordProperty("seed", std::to_string(kSeed));
  const test::TemporaryFolder folder;
  const auto samples = test::scan_samples();
  test::Damage damage(kSeed);
  std::map<std::string, int> read, refused;
  for (std::size_t i = 0; i < kFiles; ++i) {
    const auto& sample = samples[i % samples.size()];
    const auto path = folder.write("scan" + sample.extension, damage(sample.bytes));
    const std::string kind = sample.extension + " " + sample.encoding;
    try {
      const Cloud cloud = read_cloud_file(path);
      ++read[kind];
      EXPECT_LE(cloud.points.size(), std::filesystem::file_size(path) * 88)
          << "seed " << kSeed << ", file " << i;
      for (const auto& point : cloud.points) {
        ASSERT_TRUE(point.allFinite()) << "seed " << kSeed << ", file " << i;
      }
    } catch (const FileError&) {
      ++refused[kind];
    }
  }
  int all = 0;
  for (const auto& sample : samples) {
    const std::string kind = sample.extension + " " + sample.encoding;
    EXPECT_GT(read[kind], 50) << kind;
    EXPECT_GT(refused[kind], 50) << kind;
    all += read[kind] + refused[kind];
  }
  EXPECT_EQ(all, kFiles);
}

TEST(DamagedTables, AreReadOrRefused) {
  constexpr int kFiles = 2'000;
  constexpr std::uint64_t kSeed = 7;
  const std::string poses =
      "index,file,utime,x,y,z,qx,qy,qz,qw\n0,a.ply,1000000,1,2,3,0,0,0,1\n1,b.ply,2000000,1,2,3,0,"
      "0,1,0\n";
  const std::string trajectory = "# t x y z\n1.5 1 2 3 0 0 0 1\n2.5 1 2 3 0 0 1 0\n";
  const test::TemporaryFolder folder;
  test::Damage damage(kSeed);
  int read = 0, refused = 0;
  for (int i = 0; i < kFiles; ++i) {
    try {
      if (i % 2 == 0) {
        read_pose_csv(folder.write("poses.csv", damage(poses)));
      } else {
        read_tum(folder.write("t.tum", damage(trajectory)));
      }
      ++read;
    } catch (const FileError&) {
      ++refused;
    }
  }
  EXPECT_GT(read, 100);
  EXPECT_GT(refused, 100);
  EXPECT_EQ(read + refused, kFiles);
}

}  // namespace
}  // namespace voxlist::io
