#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/desk/scan_set.h"

namespace voxlist::desk {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class MapFolder : public testing::Test {
 protected:
  MapFolder() {
    test::make_scan_set(work_ / "scans");
    EXPECT_EQ(map("scans", "map").exit_code, 0);
  }

  test::DeskRun map(const std::string& input, const std::string& folder,
                    std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"map", work_ / input, "-o", work_ / folder, "--no-octomap"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::run(arguments);
  }

  nlohmann::json summary(const std::string& folder) {
    return nlohmann::json::parse(test::read_text(work_ / folder + "/summary.json"));
  }

  test::WorkFolder work_;
};

TEST_F(MapFolder, IsToldAsItsSummarySays) {
  const test::DeskRun run = test::run({"info", work_ / "map", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto info = nlohmann::json::parse(run.out);
  for (const std::string key : {"keyframes", "voxels", "map_hash", "resolution_m"})
    EXPECT_EQ(info[key], summary("map")[key]) << key;
  EXPECT_GT(info["map_id"], 0);
  EXPECT_EQ(info["left_out"], 0);
  EXPECT_GT(info["way_m"], 0.5);
  EXPECT_THAT(test::run({"info", work_ / "map"}).out, HasSubstr("keyframes "));
  EXPECT_EQ(test::run({"info", work_ / "scans"}).exit_code, 1);
}

TEST_F(MapFolder, GivesTheSameMapAgainFromItsExport) {
  ASSERT_EQ(test::run({"export", work_ / "map", "-o", work_ / "out"}).exit_code, 0);
  ASSERT_EQ(map("out", "again", {"--use-poses", work_ / "out/poses.csv"}).exit_code, 0);
  EXPECT_EQ(summary("again")["map_hash"], summary("map")["map_hash"]);
  EXPECT_THAT(test::run({"export", work_ / "map", "-o", work_ / "out"}).err,
              HasSubstr("is not empty"));
}

TEST_F(MapFolder, HasNoOctomapWhenNoneIsWanted) {
  EXPECT_FALSE(fs::exists(work_ / "map/map.bt"));
  test::write_text(work_ / "map/map.bt", "of another map");
  EXPECT_EQ(map("scans", "map").exit_code, 0);
  EXPECT_FALSE(fs::exists(work_ / "map/map.bt"));
}

TEST_F(MapFolder, OfARobotIsReplacedByForceAlone) {
  fs::remove(work_ / "map/summary.json");
  const std::string before = test::read_text(work_ / "map/keyframes.voxlist");
  const test::DeskRun run = map("scans", "map");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("holds a map that a robot"));
  EXPECT_EQ(test::read_text(work_ / "map/keyframes.voxlist"), before);
  EXPECT_EQ(map("scans", "map", {"--force"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(work_ / "map/summary.json"));
}

}  // namespace
}  // namespace voxlist::desk
