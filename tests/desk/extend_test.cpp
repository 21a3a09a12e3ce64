// `voxlist rebuild` and `voxlist extend`: maps that are there already.
#include <gmock/gmock.h>

#include <csignal>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "services/voxlist/commands/desk.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/stop.h"
#include "tests/desk/scan_set.h"
#include "tests/stored_map.h"
#include "voxlist/mapping/loops/stored_looks.h"
#include "voxlist/mapping/map_store.h"
#include "voxlist/system/file_lock.h"

namespace voxlist::desk {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

constexpr int kFirstScans = 5;

class StoredMaps : public testing::Test {
 protected:
  // A map of the drive's first scans, and all scans.
  StoredMaps() {
    test::make_scan_set(scans_);
    fs::create_directory(work_ / "first");
    for (int scan = 0; scan < kFirstScans; ++scan) {
      const std::string name = "/scan_" + std::to_string(scan) + ".ply";
      fs::copy(scans_ + name, work_ / "first" + name);
    }
    EXPECT_EQ(desk({"map", work_ / "first", "-o", folder_}).exit_code, 0);
  }

  // Coarse: the OctoMap takes longer than all else.
  static test::DeskRun desk(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--octomap-resolution", "0.4"});
    return test::run(arguments);
  }

  std::string text(const std::string& name) const { return test::read_text(folder_ + "/" + name); }
  nlohmann::json summary() const { return nlohmann::json::parse(text("summary.json")); }

  void expect_refusal(std::vector<std::string> arguments, const std::string& words,
                      int exit_code = 1) {
    const std::string before = text(mapping::kKeyframeFile);
    const test::DeskRun run = desk(std::move(arguments));
    EXPECT_EQ(run.exit_code, exit_code);
    EXPECT_THAT(run.err, HasSubstr(words));
    EXPECT_EQ(text(mapping::kKeyframeFile), before);
  }

  test::WorkFolder work_;
  const std::string scans_ = work_ / "scans", folder_ = work_ / "map";
};

using Rebuild = StoredMaps;
using Extend = StoredMaps;

TEST_F(Rebuild, MakesEveryViewAnewFromTheKeyframes) {
  const std::vector<std::string> views = {"map.ply", "map.bt", "map.png", "trajectory.tum"};
  std::vector<std::string> before;
  for (const std::string& view : views) before.push_back(text(view));
  const auto old = summary();
  for (const std::string& view : views) fs::remove(folder_ + "/" + view);
  fs::remove(folder_ + "/summary.json");
  const test::DeskRun run = desk({"rebuild", folder_});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(text("map.ply"), before[0]);
  EXPECT_EQ(text("map.bt"), before[1]);
  EXPECT_THAT(text("map.png"), StartsWith("\x89PNG"));
  EXPECT_EQ(test::read_lines(folder_ + "/trajectory.tum").size(),
            1u + old["keyframes"].get<std::size_t>());
  for (const std::string key : {"map_hash", "keyframes", "voxels"})
    EXPECT_EQ(summary()[key], old[key]);
}

TEST_F(Rebuild, KeepsWhatIsKnownOfTheScansBetweenTheKeyframes) {
  test::write_text(work_ / "robot.toml", "[mapper]\nmin_distance_m = 1.0\nmin_turn_deg = 180\n");
  ASSERT_EQ(
      desk({"map", work_ / "first", "-o", folder_, "--config", work_ / "robot.toml"}).exit_code, 0);
  const std::string trajectory = text("trajectory.tum");
  const auto old = summary();
  ASSERT_GT(old["placed"], old["keyframes"]);
  ASSERT_EQ(desk({"rebuild", folder_}).exit_code, 0);
  EXPECT_EQ(text("trajectory.tum"), trajectory);
  EXPECT_EQ(summary(), old);
}

TEST_F(Rebuild, LeavesOutWhatIsDamaged) {
  const auto old = summary();
  std::string bytes = text(mapping::kKeyframeFile);
  bytes[bytes.size() / 2] ^= 1;
  test::write_text(folder_ + "/" + mapping::kKeyframeFile, bytes);
  fs::remove(folder_ + "/trajectory.tum");
  const test::DeskRun run = desk({"rebuild", folder_});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("damaged in 1 place"));
  EXPECT_EQ(summary()["keyframes"], old["keyframes"].get<int>() - 1);
  EXPECT_EQ(text(mapping::kKeyframeFile), bytes);
  EXPECT_EQ(test::read_lines(folder_ + "/trajectory.tum").size(),
            old["keyframes"].get<std::size_t>());
}

TEST_F(Rebuild, LeavesARobotsMapARobots) {
  fs::remove(folder_ + "/summary.json");
  ASSERT_EQ(desk({"rebuild", folder_}).exit_code, 0);
  expect_refusal({"map", scans_, "-o", folder_}, "that a robot");
}

TEST_F(Rebuild, IsRefusedWithoutAMapAndWhileAMapperWorks) {
  expect_refusal({"rebuild", scans_}, "keyframes.voxlist: is not there");
  expect_refusal({"rebuild", work_ / "none"}, "keyframes.voxlist: is not there");
  EXPECT_FALSE(fs::exists(work_ / "none"));
  const auto lock = FileLock::take(folder_ + "/" + mapping::kMapLock);
  expect_refusal({"rebuild", folder_}, "works in this map folder");
}

TEST_F(Extend, AddsWhatIsNewBehindWhatWasThere) {
  const auto old = summary();
  const std::string keyframes = text(mapping::kKeyframeFile);
  const auto id = test::load_map(folder_).map_id;
  const test::DeskRun run = desk({"extend", folder_, scans_});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("12 of 12 scans placed"));
  EXPECT_THAT(text(mapping::kKeyframeFile), StartsWith(keyframes));
  EXPECT_GT(summary()["keyframes"], old["keyframes"]);
  EXPECT_GT(summary()["voxels"], old["voxels"]);
  EXPECT_EQ(summary()["placed"], old["placed"].get<int>() + test::kScans);
  EXPECT_EQ(summary()["extended_by"], nlohmann::json({scans_}));
  EXPECT_EQ(test::read_lines(folder_ + "/trajectory.tum").size(), 1u + kFirstScans + test::kScans);
  const auto loaded = test::load_map(folder_);
  EXPECT_EQ(loaded.warning, "");
  EXPECT_EQ(loaded.map_id, id);
  EXPECT_EQ(loaded.keyframes.size(), summary()["keyframes"]);
  expect_refusal({"map", scans_, "-o", folder_}, "voxlist extend");
}

TEST_F(Extend, GivesAMapThatCanBeExportedThoughItsTimesGoBack) {
  ASSERT_EQ(desk({"map", scans_, "-o", folder_, "--force"}).exit_code, 0);
  test::write_text(work_ / "robot.toml", "[mapper]\nmin_news = 0.0\n");
  ASSERT_EQ(desk({"extend", folder_, work_ / "first", "--config", work_ / "robot.toml"}).exit_code,
            0);
  const test::DeskRun out = test::run({"export", folder_, "-o", work_ / "out"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_THAT(out.err, HasSubstr("times go back"));
  const test::DeskRun again =
      desk({"map", work_ / "out", "-o", work_ / "again", "--use-poses", work_ / "out/poses.csv"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(nlohmann::json::parse(test::read_text(work_ / "again/summary.json"))["map_hash"],
            summary()["map_hash"]);
}

TEST_F(Extend, IsWhatMapDoesWhenItIsToldAMapToExtend) {
  const std::string other = work_ / "other";
  fs::copy(folder_, other, fs::copy_options::recursive);
  ASSERT_EQ(desk({"extend", folder_, scans_}).exit_code, 0);
  ASSERT_EQ(desk({"map", scans_, "--into", other}).exit_code, 0);
  for (const std::string file : {"keyframes.voxlist", "graph.g2o", "map.ply", "trajectory.tum"})
    EXPECT_EQ(test::read_text(other + "/" + file), text(file)) << file;
  EXPECT_GT(desk({"map", scans_}).exit_code, 100);
  EXPECT_GT(desk({"map", scans_, "--into", other, "-o", folder_}).exit_code, 100);
}

TEST_F(Extend, GivesTheSameMapByTheLooksOfTheSessionBeforeAndByNewOnes) {
  const std::string other = work_ / "other", looks = std::string("/") + mapping::kLooksFile;
  ASSERT_EQ(desk({"extend", folder_, scans_}).exit_code, 0);
  ASSERT_TRUE(fs::exists(folder_ + looks));
  fs::copy(folder_, other, fs::copy_options::recursive);
  test::write_text(other + looks, "torn");
  ASSERT_EQ(desk({"extend", folder_, work_ / "first"}).exit_code, 0);
  ASSERT_EQ(desk({"extend", other, work_ / "first"}).exit_code, 0);
  for (const std::string file : {"keyframes.voxlist", "graph.g2o", "map.ply", mapping::kLooksFile})
    EXPECT_EQ(test::read_text(other + "/" + file), text(file)) << file;
}

TEST_F(Extend, GivesTheVeryMapThatARebuildGives) {
  ASSERT_EQ(desk({"extend", folder_, scans_}).exit_code, 0);
  const std::string voxels = text("map.ply"), octomap = text("map.bt");
  ASSERT_EQ(desk({"rebuild", folder_}).exit_code, 0);
  EXPECT_EQ(text("map.ply"), voxels);
  EXPECT_EQ(text("map.bt"), octomap);
}

TEST_F(Extend, LeavesAMapAloneInWhichNoScanIsFound) {
  fs::create_directory(work_ / "elsewhere");
  std::string cloud =
      "ply\nformat ascii 1.0\nelement vertex 200\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n";
  for (int i = 0; i < 200; ++i)
    cloud += std::to_string(3 + i % 7) + ' ' + std::to_string(i * i % 11) + ' ' +
             std::to_string(0.01 * i) + '\n';
  test::write_text(work_ / "elsewhere/scan_0.ply", cloud);
  const std::string views = text("map.ply") + text("summary.json");
  expect_refusal({"extend", folder_, work_ / "elsewhere"}, "none of the 1 scans", 3);
  EXPECT_EQ(text("map.ply") + text("summary.json"), views);
}

TEST_F(Extend, IsRefusedWithoutAMapAndWhileAMapperWorks) {
  expect_refusal({"extend", work_ / "none", scans_}, "keyframes.voxlist: is not there");
  EXPECT_FALSE(fs::exists(work_ / "none"));
  expect_refusal({"extend", folder_, work_ / "none"}, "none: is not there");
  const auto lock = FileLock::take(folder_ + "/" + mapping::kMapLock);
  expect_refusal({"extend", folder_, scans_}, "works in this map folder");
}

// Does something when the first thing is written.
class ActingBuffer : public std::stringbuf {
 public:
  explicit ActingBuffer(std::function<void()> act) : act_(std::move(act)) {}

 private:
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    if (act_) std::exchange(act_, {})();
    return std::stringbuf::xsputn(text, size);
  }
  std::function<void()> act_;
};

// Extends the map; `act` is called in the middle, when a damaged scan is told.
int extend_and(std::function<void()> act, const std::string& folder, const std::string& scans) {
  test::write_text(scans + "/scan_10.ply", "damaged");
  std::ostringstream out;
  ActingBuffer buffer(std::move(act));
  std::ostream err(&buffer);
  Console console(out, err, false);
  stop_on_interrupt();
  const int exit_code = run_desk({"extend", folder, scans, "--no-octomap"}, console);
  stop_on_interrupt();
  return exit_code;
}

TEST_F(Extend, KeepsWhatItHasWhenInterrupted) {
  const std::string keyframes = text(mapping::kKeyframeFile);
  EXPECT_EQ(extend_and([] { std::raise(SIGINT); }, folder_, scans_), kInterrupted);
  EXPECT_THAT(text(mapping::kKeyframeFile), StartsWith(keyframes));
  EXPECT_EQ(test::load_map(folder_).keyframes.size(), summary()["keyframes"]);
  EXPECT_EQ(summary()["interrupted"], true);
}

// A copy of the folder in the middle of the work is what a kill would leave.
TEST_F(Extend, LosesNothingWhenItIsKilled) {
  const std::string killed = work_ / "killed";
  const auto before = test::load_map(folder_).keyframes.size();
  const auto copy = [&] { fs::copy(folder_, killed, fs::copy_options::recursive); };
  ASSERT_EQ(extend_and(copy, folder_, scans_), 0);
  const auto loaded = test::load_map(killed);
  EXPECT_EQ(loaded.warning, "");
  EXPECT_GT(loaded.keyframes.size(), before);
  EXPECT_LT(loaded.keyframes.size(), test::load_map(folder_).keyframes.size());
  EXPECT_EQ(desk({"rebuild", killed}).exit_code, 0);
}

}  // namespace
}  // namespace voxlist::desk
