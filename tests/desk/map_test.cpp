#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "services/voxlist/commands/desk.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/stop.h"
#include "tests/desk/scan_set.h"
#include "tests/stored_map.h"
#include "voxlist/evaluation/evaluation.h"
#include "voxlist/io/clouds/cloud_file.h"
#include "voxlist/io/poses/trajectory.h"
#include "voxlist/mapping/map_store.h"
#include "voxlist/simulation/random.h"
#include "voxlist/system/file_lock.h"

namespace voxlist::desk {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Arguments = std::vector<std::string>;

// A scan that fits nowhere.
Cloud random_cloud(int seed) {
  simulation::Random random(static_cast<std::uint64_t>(seed));
  Cloud cloud;
  for (int i = 0; i < 2000; ++i)
    cloud.points.push_back(Eigen::Vector3d(random.uniform(-6.0, 6.0), random.uniform(-6.0, 6.0),
                                           random.uniform(0.0, 2.0))
                               .cast<float>());
  return cloud;
}

class Map : public testing::Test {
 protected:
  Map() { test::make_scan_set(scans_); }

  // Coarse: the OctoMap takes longer than all else.
  test::DeskRun map(const std::string& input, const std::string& folder, Arguments more = {}) {
    Arguments arguments = {"map", input, "-o", folder, "--octomap-resolution", "0.4"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::run(arguments);
  }

  static nlohmann::json summary(const std::string& folder) {
    return nlohmann::json::parse(test::read_text(folder + "/summary.json"));
  }

  std::string import() {
    EXPECT_EQ(test::run({"import", scans_, "-o", work_ / "log"}).exit_code, 0);
    return work_ / "log";
  }

  test::WorkFolder work_;
  const std::string scans_ = work_ / "scans", folder_ = work_ / "map";
};

TEST_F(Map, PlacesEveryScanOfASimulatedDriveNearItsTruth) {
  const test::DeskRun run = map(scans_, folder_);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto errors = evaluation::evaluate(io::read_tum(folder_ + "/trajectory.tum"),
                                           io::read_pose_csv(scans_ + "/poses.csv"));
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->matched, static_cast<std::size_t>(test::kScans));
  EXPECT_LT(errors->aligned_m.rmse, 0.05);
}

TEST_F(Map, LeavesAFolderAloneInWhichAMapperWorks) {
  std::filesystem::create_directories(folder_);
  const auto mapper = FileLock::take(std::filesystem::path(folder_) / mapping::kMapLock);
  const test::DeskRun run = map(scans_, folder_);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("works in this map folder"));
  EXPECT_FALSE(std::filesystem::exists(folder_ + "/" + mapping::kKeyframeFile));
}

TEST_F(Map, TellsTheSameInTheSummaryAsInTheFiles) {
  ASSERT_EQ(map(scans_, folder_).exit_code, 0);
  const auto json = summary(folder_);
  EXPECT_EQ(json["scans"], test::kScans);
  EXPECT_EQ(json["placed"], test::kScans);
  EXPECT_EQ(json["left_out"], 0);
  EXPECT_EQ(json["seconds"], test::kScans - 1.0);
  EXPECT_GT(json["real_time_factor"], 0.0);
  EXPECT_EQ(json["voxels"], io::read_cloud_file(folder_ + "/map.ply").points.size());
  const test::StoredMap stored = test::load_map(folder_);
  EXPECT_EQ(json["keyframes"], stored.keyframes.size());
  EXPECT_GT(stored.keyframes.size(), 1u);
  EXPECT_EQ(stored.warning, "");
  mapping::MapBuilder again;
  for (const mapping::Keyframe& keyframe : stored.keyframes) again.add(keyframe);
  EXPECT_EQ(again.map().occupied.hash(),
            std::stoull(json["map_hash"].get<std::string>(), nullptr, 16));
  EXPECT_GT(fs::file_size(folder_ + "/map.png"), 1000u);
}

TEST_F(Map, IsTheSameFromALogAsFromItsFolder) {
  ASSERT_EQ(map(import(), folder_).exit_code, 0);
  ASSERT_EQ(map(scans_, work_ / "other").exit_code, 0);
  EXPECT_EQ(summary(folder_)["map_hash"], summary(work_ / "other")["map_hash"]);
  for (const std::string file : {"/trajectory.tum", "/keyframes.voxlist", "/map.bt", "/map.ply"}) {
    EXPECT_GT(fs::file_size(folder_ + file), 500u) << file;
    EXPECT_EQ(test::read_text(folder_ + file), test::read_text(work_ / "other" + file)) << file;
  }
}

TEST_F(Map, IsTheSameWhateverTheNumberOfThreads) {
  ASSERT_EQ(map(scans_, folder_, {"--threads", "1"}).exit_code, 0);
  const std::string first = test::read_text(folder_ + "/keyframes.voxlist");
  EXPECT_GT(first.size(), 10'000u);
  ASSERT_EQ(map(scans_, folder_, {"--threads", "4"}).exit_code, 0);
  EXPECT_EQ(test::read_text(folder_ + "/keyframes.voxlist"), first);
}

TEST_F(Map, PutsScansAtGivenPosesAndSkipsThoseWithout) {
  test::write_text(work_ / "given.csv",
                   "scan,x,y,z,qx,qy,qz,qw\n2,1,2,3,0,0,0.6,0.8\n5,4,5,6,0,0,0,1\n");
  const test::DeskRun run = map(scans_, folder_, {"--use-poses", work_ / "given.csv"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto trajectory = io::read_tum(folder_ + "/trajectory.tum");
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[0].utime_us, 3'000'000);
  EXPECT_TRUE(trajectory[0].pose.translation().isApprox(Eigen::Vector3d(1.0, 2.0, -3.0)));
  EXPECT_TRUE(trajectory[1].pose.translation().isApprox(Eigen::Vector3d(4.0, 5.0, 0.0)));
  EXPECT_THAT(run.err, HasSubstr("heights are counted from 6.00 m"));
  EXPECT_THAT(run.err, HasSubstr("1 of 2 poses are more than 0.2 m above or below"));
  EXPECT_NEAR(to_pose2(trajectory[0].pose).yaw_rad, 2.0 * std::atan2(0.6, 0.8), 1e-9);
  EXPECT_EQ(test::load_map(folder_).keyframes.size(), 2u);
  EXPECT_EQ(summary(folder_)["without_pose"], test::kScans - 2);
}

TEST_F(Map, FindsGivenPosesForALogByTime) {
  test::write_text(work_ / "given.csv", "t,x,y,yaw\n3.004,1,2,0.5\n4.5,9,9,0\n");
  const test::DeskRun run = map(import(), folder_, {"--use-poses", work_ / "given.csv"});
  ASSERT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("poses: row 1 has no scan"));
  const auto trajectory = io::read_tum(folder_ + "/trajectory.tum");
  ASSERT_EQ(trajectory.size(), 1u);
  EXPECT_EQ(trajectory[0].utime_us, 3'000'000);
}

TEST_F(Map, TakesThePosesOfItsOwnTrajectoryAndTellsWhichRowHasNoScan) {
  ASSERT_EQ(map(scans_, folder_).exit_code, 0);
  fs::remove(scans_ + "/scan_3.ply");
  const test::DeskRun run =
      map(scans_, work_ / "again", {"--use-poses", folder_ + "/trajectory.tum"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("row 3 has no scan"));
  auto expected = io::read_tum(folder_ + "/trajectory.tum");
  expected.erase(expected.begin() + 3);
  const auto again = io::read_tum(work_ / "again/trajectory.tum");
  ASSERT_EQ(again.size(), expected.size());
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_EQ(again[i].utime_us, expected[i].utime_us);
    EXPECT_TRUE(again[i].pose.isApprox(expected[i].pose, 1e-6)) << i;
  }
}

TEST_F(Map, GivesScansWithoutTimesThoseOfTheirRows) {
  fs::remove(scans_ + "/poses.csv");
  fs::remove(scans_ + "/odometry.csv");
  for (int i = 4; i < test::kScans; ++i) fs::remove(scans_ + "/scan_" + std::to_string(i) + ".ply");
  fs::remove(scans_ + "/scan_1.ply");
  test::write_text(work_ / "given.csv", "index,x,y,yaw\n0,0,0,0\n1,1,0,0\n2,2,0,0\n3,3,0,0\n");
  ASSERT_EQ(map(scans_, folder_, {"--use-poses", work_ / "given.csv"}).exit_code, 0);
  const auto trajectory = io::read_tum(folder_ + "/trajectory.tum");
  ASSERT_EQ(trajectory.size(), 3u);
  EXPECT_EQ(trajectory[1].utime_us, 2'000'000);
  EXPECT_EQ(trajectory[1].pose.translation().x(), 2.0);
}

TEST_F(Map, TakesTheOffsetOffPosesFarFromTheOriginAndTells) {
  test::write_text(work_ / "utm.csv",
                   "index,x,y,z,yaw\n0,458074.6,5429380.2,2,0\n1,458075.0,5429380.2,2,0\n");
  const test::DeskRun run = map(scans_, folder_, {"--use-poses", work_ / "utm.csv"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("5449 km from the origin"));
  EXPECT_THAT(run.err, HasSubstr("an offset of (458075, 5429380, 2) m is taken off"));
  EXPECT_GT(summary(folder_)["voxels"], 100);
  EXPECT_EQ(summary(folder_)["offset_m"], nlohmann::json({458075.0, 5429380.0, 2.0}));
  EXPECT_NEAR(io::read_tum(folder_ + "/trajectory.tum")[1].pose.translation().y(), 0.2, 1e-6);
}

TEST_F(Map, RefusesPosesFartherApartThanAMapReaches) {
  test::write_text(work_ / "given.csv", "index,x,y,yaw\n0,0,0,0\n1,200000,0,0\n");
  const test::DeskRun run = map(scans_, folder_, {"--use-poses", work_ / "given.csv"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("pose 1 lies 200 km from the origin"));
}

TEST_F(Map, OfScansInMillimetresIsEmptyAndSaidSo) {
  Cloud cloud;
  for (int i = 0; i < 60; ++i)
    cloud.points.emplace_back(2500.0F, 40.0F * static_cast<float>(i), 500.0F);
  fs::create_directory(work_ / "mm");
  io::write_ply(work_ / "mm/scan_0.ply", cloud);
  test::write_text(work_ / "given.csv", "index,x,y,yaw\n0,0,0,0\n");
  const test::DeskRun run = map(work_ / "mm", folder_, {"--use-poses", work_ / "given.csv"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("are they millimetres?"));
  EXPECT_THAT(run.err, HasSubstr("the map is empty"));
  EXPECT_LT(fs::file_size(folder_ + "/map.bt"), 1000u);
}

TEST_F(Map, HasNoVoxelWhereTheRobotStoodForRaysThatDidNotComeBack) {
  Cloud cloud;
  for (int i = 0; i < 100; ++i) {
    cloud.points.emplace_back(2.0F, 0.05F * static_cast<float>(i), 0.5F);
    cloud.points.emplace_back(0.0F, 0.0F, 0.0F);
  }
  fs::create_directory(work_ / "zeros");
  io::write_ply(work_ / "zeros/scan_0.ply", cloud);
  test::write_text(work_ / "given.csv", "index,x,y,yaw\n0,1,2,0\n");
  ASSERT_EQ(map(work_ / "zeros", folder_, {"--use-poses", work_ / "given.csv"}).exit_code, 0);
  const Cloud voxels = io::read_cloud_file(folder_ + "/map.ply");
  EXPECT_GE(voxels.points.size(), 90u);
  for (const auto& voxel : voxels.points)
    EXPECT_GT((voxel - Eigen::Vector3f(1.0F, 2.0F, 0.0F)).norm(), 0.1F);
}

TEST_F(Map, HasAnExitCodeWhenNoScanWasPlaced) {
  fs::create_directory(work_ / "blind");
  test::write_text(work_ / "blind/a.ply",
                   "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                   "property float y\nproperty float z\nend_header\nnan nan nan\n");
  const test::DeskRun run = map(work_ / "blind", folder_);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("the map is empty: no scan was placed"));
}

TEST_F(Map, HasAnExitCodeAndALastLineWhenLessThanHalfWasPlaced) {
  for (int scan = 4; scan < test::kScans; ++scan)
    io::write_ply(fmt::format("{}/scan_{}.ply", scans_, scan), random_cloud(scan));
  const test::DeskRun run = map(scans_, folder_);
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(summary(folder_)["placed"], 4);
  EXPECT_EQ(test::load_map(folder_).warning, "");
  const std::string last = run.err.substr(run.err.rfind('\n', run.err.size() - 2) + 1);
  EXPECT_THAT(last, HasSubstr("8 of 12 scans have no place in the map"));
  EXPECT_THAT(last, HasSubstr("scan 4 at 4.0 s was the first that fitted nowhere"));
  EXPECT_THAT(last, HasSubstr("scans that are closer together"));
}

TEST_F(Map, RefusesGivenPosesOfAnotherRun) {
  test::write_text(work_ / "given.csv", "t,x,y,yaw\n1000,1,2,0.5\n");
  const test::DeskRun run = map(import(), folder_, {"--use-poses", work_ / "given.csv"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("matches none of the scans"));
}

TEST_F(Map, TakesTheRobotsSettingsAndLeavesKeysOfTheServicesToThem) {
  test::write_text(work_ / "robot.toml",
                   "[bus]\nprefix = 'a/'\n[mapper]\nfolder = 'x'\nmin_distance_m = 100\n"
                   "min_turn_deg = 180\n");
  ASSERT_EQ(map(scans_, folder_, {"--config", work_ / "robot.toml"}).exit_code, 0);
  EXPECT_EQ(summary(folder_)["keyframes"], 1);
  test::write_text(work_ / "robot.toml", "[mapper]\nmax_range_m = -1\n");
  const test::DeskRun run = map(scans_, folder_, {"--config", work_ / "robot.toml"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("robot.toml:2: mapper.max_range_m is -1"));
}

TEST_F(Map, ReplacesItsOwnFilesAndLeavesOthersAlone) {
  fs::create_directory(folder_);
  test::write_text(folder_ + "/summary.json", "old");
  test::write_text(folder_ + "/notes.txt", "mine");
  ASSERT_EQ(map(scans_, folder_).exit_code, 0);
  EXPECT_EQ(summary(folder_)["scans"], test::kScans);
  EXPECT_EQ(test::read_text(folder_ + "/notes.txt"), "mine");
  const fs::directory_iterator files(folder_);
  EXPECT_EQ(std::distance(begin(files), end(files)), 11);  // and mapper.lock
}

TEST_F(Map, GoesOnAfterADamagedScan) {
  test::write_text(scans_ + "/scan_3.ply", "damaged");
  const test::DeskRun run = map(scans_, folder_);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("scan_3.ply"));
  EXPECT_EQ(summary(folder_)["placed"], test::kScans - 1);
  EXPECT_EQ(summary(folder_)["left_out"], 1);
}

TEST_F(Map, IsReadByTheToolsOfOctomap) {
  if (std::system("command -v convert_octree bt2vrml >/dev/null") != 0)
    GTEST_SKIP() << "the package octomap-tools is not installed";
  ASSERT_EQ(map(scans_, folder_).exit_code, 0);
  const std::string bt = folder_ + "/map.bt", quiet = " >" + (work_ / "printed") + " 2>&1";
  EXPECT_EQ(std::system(("convert_octree " + bt + " " + (work_ / "map.ot") + quiet).c_str()), 0);
  EXPECT_EQ(std::system(("bt2vrml " + bt + quiet).c_str()), 0);
  EXPECT_GT(fs::file_size(bt + ".wrl"), 1000u);
}

// Presses Ctrl-C when the first thing is written.
class InterruptingBuffer : public std::stringbuf {
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    if (!stop_requested()) std::raise(SIGINT);
    return std::stringbuf::xsputn(text, size);
  }
};

TEST_F(Map, KeepsWhatItHasWhenInterrupted) {
  test::write_text(scans_ + "/scan_3.ply", "damaged");
  fs::create_directory(folder_);
  test::write_text(folder_ + "/map.bt", "of another map");
  std::ostringstream out;
  InterruptingBuffer buffer;
  std::ostream err(&buffer);
  Console console(out, err, false);
  stop_on_interrupt();
  const int exit_code = run_desk({"map", scans_, "-o", folder_}, console);
  stop_on_interrupt();
  EXPECT_EQ(exit_code, kInterrupted);
  EXPECT_EQ(summary(folder_)["placed"], 3);
  EXPECT_EQ(summary(folder_)["interrupted"], true);
  EXPECT_EQ(test::load_map(folder_).warning, "");
  EXPECT_FALSE(fs::exists(folder_ + "/map.bt"));
}

}  // namespace
}  // namespace voxlist::desk
