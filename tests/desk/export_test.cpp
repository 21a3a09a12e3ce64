// `voxlist export`: what planners want of a map.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "services/voxlist/commands/views/distance_field.h"
#include "tests/desk/scan_set.h"

namespace voxlist::desk {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class Export : public testing::Test {
 protected:
  Export() {
    test::make_scan_set(scans_);
    const test::DeskRun run = test::run(
        {"map", scans_, "-o", map_, "--no-octomap", "--use-poses", scans_ + "/poses.csv"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }

  test::DeskRun run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"export", map_, "-o", plans_});
    return test::run(arguments);
  }

  std::string config(const std::string& text) {
    std::ofstream(work_ / "robot.toml") << text;
    return work_ / "robot.toml";
  }

  bool has(const std::string& file) const { return std::filesystem::exists(plans_ + "/" + file); }

  test::WorkFolder work_;
  const std::string scans_ = work_ / "scans", map_ = work_ / "map", plans_ = work_ / "plans";
};

TEST_F(Export, WritesAFloorPlanForEachRobot) {
  const std::string robots = config("[[robot]]\nname = 'low'\n[[robot]]\nname = 'tall'\n");
  const test::DeskRun done = run({"--grid", "--config", robots});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  for (const char* file : {"low.pgm", "low.yaml", "low.png", "tall.pgm", "tall.yaml", "tall.png"})
    EXPECT_TRUE(has(file)) << file;
  EXPECT_THAT(done.out, HasSubstr("m2 free"));
  EXPECT_THAT(test::read_text(plans_ + "/low.yaml"), HasSubstr("image: low.pgm\n"));
  // Something is free.
  EXPECT_NE(test::read_text(plans_ + "/low.pgm").find('\xFE'), std::string::npos);
}

TEST_F(Export, WritesThatOfADefaultRobotWhereNoneIsListed) {
  EXPECT_EQ(run({"--grid"}).exit_code, 0);
  EXPECT_TRUE(has("robot.yaml"));
}

TEST_F(Export, WritesAScanOfEachKeyframeForEachRobot) {
  const std::string robots =
      config("[[robot]]\nname = 'low'\nheight_m = 0.4\n[[robot]]\nname = 'tall'\n");
  const test::DeskRun done = run({"--scan", "--config", robots});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  for (const char* file :
       {"low_scan.csv", "low_scan_far.csv", "tall_scan.csv", "tall_scan_far.csv"})
    EXPECT_EQ(test::read_lines(plans_ + "/" + file).size(), 1U + test::kScans) << file;
  const auto lines = test::read_lines(plans_ + "/tall_scan.csv");
  EXPECT_THAT(lines[0], StartsWith("index,utime,x_m,y_m,yaw_rad,step_rad,range_0_m,"));
  EXPECT_EQ(std::ranges::count(lines[0], ','), std::ranges::count(lines[1], ','));
  EXPECT_THAT(lines[1], StartsWith("0,"));
  // Somewhere there is a wall within 10 m.
  EXPECT_THAT(lines[1], testing::ContainsRegex(",[0-9][.][0-9][0-9][0-9],"));
  EXPECT_NE(lines, test::read_lines(plans_ + "/low_scan.csv"));
}

TEST_F(Export, WritesDistancesForNumPyAndAnOctomap) {
  const test::DeskRun done = run({"--distance", "--octomap"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const std::string field = test::read_text(plans_ + "/distance.npy");
  EXPECT_THAT(field, StartsWith("\x93NUMPY"));
  EXPECT_THAT(field.substr(0, 128), HasSubstr("'descr': '<f4'"));
  EXPECT_THAT(test::read_text(plans_ + "/distance.yaml"), HasSubstr("array: distance.npy\n"));
  EXPECT_THAT(test::read_text(plans_ + "/map.bt"), StartsWith("# Octomap"));
}

TEST_F(Export, RefusesRobotsThatCannotBeToldApart) {
  const std::string robots = config("[[robot]]\nname = 'low'\n[[robot]]\nname = 'low'\n");
  const test::DeskRun done = run({"--grid", "--config", robots});
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_THAT(done.err, HasSubstr("two robots are called \"low\""));
}

TEST(Distances, AreToTheNearestCellThatIsNotFree) {
  OccupancyMap map, free{VoxelMap(kPassedResolution_m), VoxelMap(kPassedResolution_m)};
  for (std::int32_t z = 0; z < 9; ++z)
    for (std::int32_t y = 0; y < 9; ++y)
      for (std::int32_t x = 0; x < 9; ++x) free.passed.insert({x, y, z});
  const auto at = [](const DistanceField& field, std::size_t x, std::size_t y, std::size_t z) {
    return field.far_m[(z * 9 + y) * 9 + x];
  };
  const auto box = known_box(free);
  ASSERT_TRUE(box);
  const VoxelBox cells{{0, 0, 0}, {8, 8, 8}};
  const DistanceField empty = distance_field(map, free, cells, 2.0);
  EXPECT_NEAR(at(empty, 4, 4, 4), 5 * 0.08, 1e-5) << "unknown is not free";
  EXPECT_NEAR(at(empty, 0, 4, 4), 0.08, 1e-5);
  map.occupied.insert({4 * 4 + 1, 4 * 4, 4 * 4});
  const DistanceField field = distance_field(map, free, cells, 2.0);
  EXPECT_EQ(at(field, 4, 4, 4), 0.0F);
  EXPECT_NEAR(at(field, 6, 4, 4), 2 * 0.08, 1e-5);
  EXPECT_NEAR(at(field, 5, 5, 4), std::sqrt(2.0) * 0.08, 1e-5);
  EXPECT_NEAR(at(distance_field(map, free, cells, 0.1), 2, 4, 4), 0.1, 1e-5)
      << "no more than asked for";
}

}  // namespace
}  // namespace voxlist::desk
