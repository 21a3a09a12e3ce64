// grid_planner of tests/clients: its ways are held against the true building, and it plans anew
// when the grid has changed.
#include <gmock/gmock.h>

#include <voxlist/pixel_map_t.hpp>

#include "tests/bench/paths/grid_paths.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/event_log.h"

namespace voxlist {
namespace {

// A building on which nothing was chosen (see tests/bench/README.md).
constexpr int kSeed = 172, kErrands = 3;

void expect_kept(const bench::PathTally& tally) {
  EXPECT_EQ(tally.errands, kErrands);
  EXPECT_GT(tally.ways, 0);
  EXPECT_EQ(tally.missed, 0);
  EXPECT_GE(tally.found, tally.ways);
  EXPECT_EQ(tally.collided, 0);
  EXPECT_EQ(tally.through_unknown, 0);
}

TEST(PathInAGrid, OfALowRobotTouchesNothingAndIsKnown) {
  expect_kept(bench::plan_in_grid(kSeed, kErrands, bench::kLowRobot));
}

TEST(PathInAGrid, OfATallRobotTouchesNothingAndIsKnown) {
  expect_kept(bench::plan_in_grid(kSeed, kErrands, bench::kTallRobot));
}

// 20 x 10 cells of 0.1 m, as they come without compression.
pixel_map_t free_grid() {
  pixel_map_t grid{};
  grid.dimensions[0] = 20;
  grid.dimensions[1] = 10;
  grid.xy1[0] = 2.0;
  grid.xy1[1] = 1.0;
  grid.mpp = 0.1;
  grid.data_type = pixel_map_t::DATA_TYPE_UINT8;
  grid.mapData.assign(200, 0);
  grid.datasize = 200;
  return grid;
}

// A column of cells, all of it but for its upper part.
pixel_map_t with_wall(std::uint8_t value, std::size_t gap) {
  pixel_map_t grid = free_grid();
  for (std::size_t y = 0; y < 10 - gap; ++y) grid.mapData[20 * y + 10] = value;
  return grid;
}

TEST(GridPlanner, PlansAnewWhenTheGridHasChangedAndTakesUnknownForNotFree) {
  const test::TemporaryFolder folder;
  const std::string log = (folder / "grids.lcm").string();
  bus::EventLogWriter writer(log);
  std::int64_t utime = 0;
  for (const pixel_map_t& grid :
       {free_grid(), free_grid(), with_wall(255, 5), with_wall(127, 5), with_wall(127, 0)})
    writer.write(bus::Channel<pixel_map_t>{"GRID_robot"}, ++utime, grid);
  writer.close();
  const std::string command = "LCM_DEFAULT_URL='file://" + log +
                              "?speed=0' '" VOXLIST_BIN_DIR
                              "/grid_planner' GRID_robot 0.1 0.35 0.35 1.65 0.35";
  const std::unique_ptr<FILE, int (*)(FILE*)> out(popen(command.c_str(), "r"), pclose);
  std::vector<int> points{0};  // of each plan
  for (char line[100]; std::fgets(line, sizeof line, out.get());)
    line[0] == '\n' ? points.push_back(0) : static_cast<void>(++points.back());
  ASSERT_EQ(points.size(), 5U);  // the grid that came twice was planned once
  EXPECT_EQ(points[0], 14);      // straight on
  EXPECT_GE(points[1], 14);      // round the wall
  EXPECT_EQ(points[2], points[1]);
  EXPECT_EQ(points[3], 0);
}

}  // namespace
}  // namespace voxlist
