// What people look at of a map.
#include "voxlist/mapping/map_views.h"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/temporary_folder.h"
#include "voxlist/io/clouds/cloud_file.h"

namespace voxlist::mapping {
namespace {

using testing::HasSubstr;

// A wall of 64 x 64 voxels.
OccupancyMap wall() {
  OccupancyMap map;
  for (int x = -32; x < 32; ++x)
    for (int z = 0; z < 64; ++z) map.occupied.insert({x, 7, z});
  return map;
}

TEST(MapViews, AMapOfManyVoxelsIsShownInCoarserCells) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "map.ply";
  const auto header = [&] { return io::read_file(file).substr(0, 200); };
  write_map_views(folder.path(), wall(), {});
  EXPECT_EQ(io::read_cloud_file(file).points.size(), 4096U);
  EXPECT_THAT(header(), HasSubstr("comment voxels of 0.02 m\n"));
  write_map_views(folder.path(), wall(), {}, {}, 4095);
  EXPECT_EQ(io::read_cloud_file(file).points.size(), 1024U);
  write_map_views(folder.path(), wall(), {}, {}, 256);
  EXPECT_THAT(header(), HasSubstr("comment voxels of 0.08 m\n"));
  const Cloud cells = io::read_cloud_file(file);
  ASSERT_EQ(cells.points.size(), 256U);
  for (const Eigen::Vector3f& centre : cells.points) {
    EXPECT_FLOAT_EQ(centre.y(), 0.12F);
    EXPECT_LT(std::abs(centre.x()), 0.64F);
  }
}

}  // namespace
}  // namespace voxlist::mapping
