// `voxlist octomap`: a map, or a part of it, as an OctoMap.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/desk/scan_set.h"

namespace voxlist::desk {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class OctomapCommand : public testing::Test {
 protected:
  OctomapCommand() {
    test::make_scan_set(scans_);
    const test::DeskRun run = test::run({"map", scans_, "-o", map_, "--use-poses",
                                         scans_ + "/poses.csv", "--octomap-resolution", "0.3"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }

  // The file that it writes.
  std::string written(std::vector<std::string> arguments, const std::string& name) {
    arguments.insert(arguments.begin(), {"octomap", map_, "-o", work_ / name});
    const test::DeskRun run = test::run(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out, (work_ / name) + "\n");
    return test::read_text(work_ / name);
  }

  test::WorkFolder work_;
  const std::string scans_ = work_ / "scans", map_ = work_ / "map";
};

TEST_F(OctomapCommand, WritesWhatMapWrites) {
  const std::string map = test::read_text(map_ + "/map.bt");
  EXPECT_THAT(map, StartsWith("# Octomap OcTree binary file\n"));
  EXPECT_TRUE(written({"--resolution", "0.3"}, "all.bt") == map);
  EXPECT_TRUE(written({"--resolution", "0.3", "--threads", "1"}, "one.bt") == map);
}

TEST_F(OctomapCommand, WritesLogOddsAtAnyResolution) {
  const std::string coarse = written({"--resolution", "0.5"}, "coarse.ot");
  EXPECT_THAT(coarse, StartsWith("# Octomap OcTree file\n"));
  EXPECT_THAT(coarse, HasSubstr("\nres 0.5\n"));
  EXPECT_GT(written({"--resolution", "0.25"}, "fine.ot").size(), 2 * coarse.size());
}

TEST_F(OctomapCommand, WritesABoxAlone) {
  const std::string all = written({"--resolution", "0.3"}, "all.bt");
  const std::string box =
      written({"--resolution", "0.3", "--box", "-1", "-1", "0", "1", "1", "1"}, "box.bt");
  EXPECT_GT(box.size(), 200u);
  EXPECT_LT(box.size(), all.size() / 4);
  EXPECT_TRUE(written({"--resolution", "0.3", "--box", "-999", "-999", "-999", "999", "999", "999"},
                      "whole.bt") == all);
}

TEST_F(OctomapCommand, WritesLargerVoxelsOfSmallerOnes) {
  const std::string large = written({"--resolution", "0.3", "--voxels", "0.6"}, "large.bt");
  EXPECT_THAT(large, HasSubstr("\nres 0.6\n"));
  EXPECT_FALSE(large == written({"--resolution", "0.6"}, "counted.bt"))
      << "what a large voxel holds is occupied, however many rays pass beside it";
  const test::DeskRun small =
      test::run({"octomap", map_, "-o", work_ / "x.bt", "--resolution", "0.3", "--voxels", "0.1"});
  EXPECT_EQ(small.exit_code, 1);
  EXPECT_THAT(small.err, HasSubstr("export_resolution_m"));
}

TEST_F(OctomapCommand, RefusesWhatItCannotWriteOrRead) {
  const test::DeskRun other = test::run({"octomap", map_, "-o", work_ / "map.txt"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.err, HasSubstr("neither .bt nor .ot"));
  const test::DeskRun none = test::run({"octomap", scans_, "-o", work_ / "map.bt"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("keyframes.voxlist"));
  EXPECT_FALSE(std::filesystem::exists(work_ / "map.bt"));
}

}  // namespace
}  // namespace voxlist::desk
