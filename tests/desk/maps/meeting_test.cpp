// Where another map lies in a map: drives through floors of offices.
#include "services/voxlist/maps/meeting.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <memory>
#include <sstream>

#include "services/voxlist/maps/map_files.h"
#include "services/voxlist/maps/stored_map.h"
#include "tests/bench/drives/twin_drive.h"
#include "tests/desk/scan_set.h"
#include "tests/mapping/graph/g2o_reader.h"
#include "tests/simulation/sphere_scan.h"
#include "tests/temporary_folder.h"
#include "voxlist/io/poses/trajectory.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::desk {
namespace {

using testing::HasSubstr;

class MeetingTest : public testing::Test {
 protected:
  static simulation::Building offices(int seed) {
    simulation::BuildingConfig config;
    config.seed = seed;
    return simulation::make_building(config);
  }

  // A map of a stretch of the drive through a building, in the frame of `T_map_world`.
  std::unique_ptr<mapping::Piece> map(const simulation::Building& building, std::size_t from,
                                      std::size_t to, const Pose2& T_map_world = {}) {
    const bench::TwinDrive drive = bench::twin_drive(building, false, 1);
    const simulation::World world(building);
    auto piece = std::make_unique<mapping::Piece>(matching::LocaliserConfig{},
                                                  mapping::MapBuilder(), spool_);
    for (std::size_t i = from; i < to && i < drive.truth.size(); ++i) {
      const auto seed = static_cast<std::uint64_t>(1000 * from + i);
      Cloud scan = simulation::scan_sphere(world, drive.truth[i], {.rays = 8000}, seed);
      scan.utime_us = static_cast<std::int64_t>(i) * 1'000'000;
      piece->add(std::move(scan), to_pose3(T_map_world * drive.truth[i]));
    }
    return piece;
  }

  std::string write(const std::string& name, const mapping::Piece& piece) {
    const std::string folder = (folder_.path() / name).string();
    const MapFiles files(folder);
    files.write_keyframes(spool_, piece.keyframes(), piece.builder().map().occupied);
    return folder;
  }

  test::DeskRun merge(const std::string& first, const std::string& second) const {
    return test::run({"merge", first, second, "-o", both_, "--octomap-resolution", "0.4"});
  }

  // Erases a box of 1 m about a voxel of a map by hand, and returns where that was.
  Eigen::Vector3d erase_some(const std::string& folder) {
    const VoxelMap map = read_map(folder, {}, console_).builder.map().occupied;
    std::optional<Eigen::Vector3d> found;
    map.for_each_voxel([&](const Voxel& v) { found = center(v, map.resolution_m()); });
    std::vector<std::string> arguments{"edit", folder, "erase"};
    for (const double half_m : {-0.5, 0.5})
      for (const double at : *found) arguments.push_back(std::to_string(at + half_m));
    const test::DeskRun run = test::run(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return *found;
  }

  // Voxels that a box of 1 m surely holds, however it is turned and a few centimetres away.
  int voxels_about(const Eigen::Vector3d& point, const std::string& folder) {
    const VoxelMap map = read_map(folder, {}, console_).builder.map().occupied;
    int voxels = 0;
    map.for_each_voxel(
        [&](const Voxel& v) { voxels += (center(v, map.resolution_m()) - point).norm() < 0.4; });
    return voxels;
  }

  Meeting meet(mapping::Piece& map, const mapping::Piece& other) {
    return find_meeting(map, other, spool_, {});
  }

  const test::TemporaryFolder folder_;
  const std::string both_ = (folder_.path() / "both").string();
  mapping::KeyframeSpool spool_{folder_.path()};
  std::ostringstream printed_;
  Console console_{printed_, printed_, false};
};

TEST_F(MeetingTest, TwoMapsOfOneFloorMeetWhereBothWereMade) {
  const Pose2 T_other_world{20.0, -7.0, 2.0};
  const auto first = map(offices(3), 0, 40);
  const auto second = map(offices(3), 20, 60, T_other_world);
  const Meeting meeting = meet(*first, *second);
  ASSERT_TRUE(meeting.T_map_other);
  EXPECT_LT(distance_m(*meeting.T_map_other * T_other_world, {}), 0.1);
  EXPECT_LT(turn_rad(*meeting.T_map_other * T_other_world, {}), 0.01);
  EXPECT_GE(meeting.fitting, 4u);
  EXPECT_LE(meeting.fitting, meeting.asked);
}

TEST_F(MeetingTest, MapsOfTwoFloorsDoNotMeet) {
  const auto first = map(offices(3), 0, 40);
  EXPECT_FALSE(meet(*first, *map(offices(4), 0, 40)).T_map_other);
}

TEST_F(MeetingTest, WhereOfficesLookAlikeItIsNotSureWhichOneItIs) {
  const simulation::Building twins = bench::twin_offices(8, 5);
  const auto first = map(twins, 0, 60);
  // Out of sight of the corridor's ends.
  const Meeting meeting = meet(*first, *map(twins, 62, 75));
  EXPECT_FALSE(meeting.T_map_other);
}

TEST_F(MeetingTest, FewScansAreNotEnough) {
  const auto first = map(offices(3), 0, 40);
  EXPECT_FALSE(meet(*first, *map(offices(3), 20, 24)).T_map_other);
}

TEST_F(MeetingTest, MergeWritesAMapOfBoth) {
  const Pose2 T_second_first{3.0, 4.0, 1.0};
  const std::string first = write("first", *map(offices(3), 0, 30)),
                    second = write("second", *map(offices(3), 15, 45, T_second_first));
  const Eigen::Vector3d erased_in_first = erase_some(first), erased_in_second = erase_some(second);
  const test::DeskRun run = merge(first, second);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("30 and 30 keyframes"));
  for (const std::string file :
       {"map.bt", "map.ply", "map.png", "summary.json", "trajectory_covariance.txt"})
    EXPECT_TRUE(std::filesystem::exists(both_ + "/" + file)) << file;
  const auto trajectory = io::read_tum(both_ + "/trajectory.tum");
  ASSERT_EQ(trajectory.size(), 60u);
  const std::string graph = test::read_text(both_ + "/graph.g2o");
  const test::G2oFile read(graph);
  EXPECT_EQ(read.vertices.size(), 60u);
  EXPECT_GT(read.edges.size(), 60u);
  EXPECT_NEAR(read.chi2(), test::chi2_told(graph), 1e-6 * read.chi2());
  EXPECT_EQ(merge(first, second).exit_code, 1) << "replaced a map";
  EXPECT_EQ(voxels_about(erased_in_first, both_), 0);
  EXPECT_EQ(voxels_about(T_second_first.inverse() * erased_in_second, both_), 0);
}

TEST_F(MeetingTest, MergeRefusesOneMapTwiceAndAFolderInUse) {
  const std::string first = write("first", *map(offices(3), 0, 2)),
                    second = write("second", *map(offices(3), 2, 4));
  EXPECT_THAT(merge(first, first + "/.").err, HasSubstr("is given twice"));
  std::filesystem::create_directory(both_);
  const FileLock mapper = mapping::lock_folder(both_);
  const test::DeskRun run = merge(first, second);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr(both_));
}

TEST_F(MeetingTest, MergeWritesNothingWhereItIsNotSure) {
  const std::string first = write("first", *map(offices(3), 0, 30)),
                    second = write("second", *map(offices(4), 0, 30));
  const test::DeskRun run = merge(first, second);
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("were not merged"));
  EXPECT_FALSE(std::filesystem::exists(both_));
}

}  // namespace
}  // namespace voxlist::desk
