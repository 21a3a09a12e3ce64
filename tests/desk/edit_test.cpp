// `voxlist edit`: boxes of a map that are erased, kept free or kept blocked by hand.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "services/voxlist/maps/stored_map.h"
#include "tests/desk/scan_set.h"
#include "voxlist/mapping/map_store.h"
#include "voxlist/system/file_lock.h"

namespace voxlist::desk {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Edit : public testing::Test {
 protected:
  Edit() {
    test::make_scan_set(scans_);
    const test::DeskRun run = desk({"map", scans_, "-o", folder_, "--use-poses",
                                    scans_ + "/poses.csv", "--octomap-resolution", "0.4"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const VoxelMap map = voxels();
    map.for_each_voxel([&](const Voxel& v) { hit_ = center(v, map.resolution_m()); });
  }

  static test::DeskRun desk(const std::vector<std::string>& arguments) {
    return test::run(arguments);
  }

  // Edits a box of 1 m about a place where something was hit.
  test::DeskRun edit(const std::string& kind) const {
    std::vector<std::string> arguments{"edit", folder_, kind};
    for (const double half_m : {-0.5, 0.5})
      for (const double at : hit_) arguments.push_back(std::to_string(at + half_m));
    return desk(arguments);
  }

  VoxelMap voxels() const {
    std::ostringstream out;
    Console console(out, out, false);
    return read_map(folder_, {}, console).builder.map().occupied;
  }

  std::size_t voxels_in_box() const {
    const VoxelMap map = voxels();
    std::size_t count = 0;
    map.for_each_voxel([&](const Voxel& v) {
      count += (center(v, map.resolution_m()) - hit_).cwiseAbs().maxCoeff() < 0.5;
    });
    return count;
  }

  std::string text(const std::string& name) const { return test::read_text(folder_ + "/" + name); }

  nlohmann::json info() const {
    return nlohmann::json::parse(desk({"info", folder_, "--json"}).out);
  }

  void rebuild() const {
    ASSERT_EQ(desk({"rebuild", folder_, "--octomap-resolution", "0.4"}).exit_code, 0);
  }

  test::WorkFolder work_;
  const std::string scans_ = work_ / "scans", folder_ = work_ / "map";
  Eigen::Vector3d hit_;
};

TEST_F(Edit, ErasesWhatWasHitUntilItIsTakenBack) {
  const auto before = info();
  const std::string octomap = text("map.bt"), points = text("map.ply");
  ASSERT_GT(voxels_in_box(), 0U);
  const test::DeskRun run = edit("erase");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("edit 1: erase"));
  EXPECT_EQ(voxels_in_box(), 0U);
  EXPECT_EQ(info()["edits"], 1);
  EXPECT_LT(info()["voxels"], before["voxels"]);
  rebuild();
  EXPECT_NE(text("map.ply"), points);
  EXPECT_NE(text("map.bt"), octomap);
  ASSERT_EQ(desk({"edit", folder_, "remove", "1"}).exit_code, 0);
  EXPECT_EQ(info()["map_hash"], before["map_hash"]);
  rebuild();
  EXPECT_EQ(text("map.ply"), points);
  EXPECT_EQ(text("map.bt"), octomap);
}

TEST_F(Edit, BlocksForPlannersAlone) {
  const std::string octomap = text("map.bt"), points = text("map.ply");
  ASSERT_EQ(edit("blocked").exit_code, 0);
  rebuild();
  EXPECT_EQ(text("map.ply"), points) << "no laser sees a wall that was drawn by hand";
  EXPECT_NE(text("map.bt"), octomap);
}

TEST_F(Edit, LastsWhenTheMapIsExtended) {
  ASSERT_EQ(edit("free").exit_code, 0);
  ASSERT_EQ(desk({"map", scans_, "--into", folder_, "--no-octomap"}).exit_code, 0);
  EXPECT_GT(info()["keyframes"], test::kScans);
  EXPECT_EQ(info()["edits"], 1);
  EXPECT_EQ(voxels_in_box(), 0U);
  EXPECT_EQ(nlohmann::json::parse(text("summary.json"))["map_hash"], info()["map_hash"]);
}

TEST_F(Edit, IsListedWithItsBox) {
  EXPECT_EQ(desk({"edit", folder_, "list"}).out, "no edits\n");
  ASSERT_EQ(desk({"edit", folder_, "erase", "1", "-2.5", "0", "0", "-1", "1.5"}).exit_code, 0);
  ASSERT_EQ(edit("free").exit_code, 0);
  const std::string list = desk({"edit", folder_, "list"}).out;
  EXPECT_THAT(list, HasSubstr("    1 erase        0.00     -2.50      0.00      1.00"));
  EXPECT_THAT(list, HasSubstr("    2 free "));
}

TEST_F(Edit, OfAMapThatIsReplacedIsKeptAside) {
  ASSERT_EQ(edit("erase").exit_code, 0);
  const std::string edits = text("edits.txt");
  const test::DeskRun run = desk({"map", scans_, "-o", folder_, "--no-octomap"});
  EXPECT_THAT(run.err, HasSubstr("edits.txt.given-up"));
  EXPECT_EQ(text("edits.txt.given-up"), edits);
  EXPECT_EQ(info()["edits"], 0);
}

TEST_F(Edit, WithADamagedFileIsToldAndNothingIsLost) {
  ASSERT_EQ(edit("erase").exit_code, 0);
  const std::string torn = text("edits.txt").substr(0, 60);
  test::write_text(folder_ + "/edits.txt", torn);
  EXPECT_THAT(desk({"info", folder_}).err, HasSubstr("edits.txt is torn"));
  EXPECT_GT(voxels_in_box(), 0U);
  ASSERT_EQ(edit("erase").exit_code, 0);
  EXPECT_EQ(text("edits.txt.damaged"), torn);
  EXPECT_EQ(voxels_in_box(), 0U);
}

TEST_F(Edit, IsRefusedInOneLineWhereItMakesNoSense) {
  const auto expect_refusal = [&](std::vector<std::string> more, const std::string& words) {
    more.insert(more.begin(), {"edit", folder_});
    const test::DeskRun run = desk(more);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, HasSubstr(words));
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1);
    EXPECT_FALSE(fs::exists(folder_ + "/edits.txt"));
  };
  expect_refusal({"erase", "0", "0", "0", "500", "1", "1"}, "an edge of the box");
  expect_refusal({"erase", "nan", "0", "0", "1", "1", "1"}, "was not edited: ");
  expect_refusal({"remove", "7"}, "has no edit 7");
  const auto lock = FileLock::take(folder_ + "/" + mapping::kMapLock);
  expect_refusal({"erase", "0", "0", "0", "1", "1", "1"}, "give --live");
  EXPECT_GT(desk({"edit", folder_}).exit_code, 100);
  EXPECT_THAT(desk({"edit", work_ / "none", "list"}).err, HasSubstr("is not there"));
}

}  // namespace
}  // namespace voxlist::desk
