#include <gmock/gmock.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <optional>
#include <string>
#include <voxlist/health_t.hpp>

#include "tests/file_size_limit.h"
#include "tests/services/mapper/wall_scene.h"
#include "tests/stored_map.h"
#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"
#include "voxlist/service/stop.h"

namespace voxlist::services {
namespace {

using test::TemporaryFolder;

TEST(Mapper, ADeadMappersMapIsThereAgainAtItsNextStart) {
  const TemporaryFolder folder;
  std::optional<WallScene> first(folder.string());
  first->request(map_request_t::WANT_MAP);
  first->drive(1, {});
  first->drive(2, {1.0, 0.0, 0.0});
  const OccupancyMap map = first->map;
  const auto map_id = first->assembler.held()->map_id;
  first.reset();  // without stop(): as after kill -9

  WallScene second(folder.string());
  second.request(map_request_t::WANT_MAP);
  EXPECT_EQ(second.assembler.held()->map_id, map_id);
  EXPECT_EQ(second.assembler.held()->version, 2);
  EXPECT_EQ(second.map.occupied.hash(), map.occupied.hash());
  EXPECT_EQ(second.map.passed.hash(), map.passed.hash());
  second.drive(3, {2.0, 0.0, 0.0});
  EXPECT_EQ(test::load_map(folder.string()).keyframes.size(), 3u);
}

// What the mapper says in HEALTH of so many keyframes that it has to add at its start.
double built_anew(WallScene& scene) {
  const health_t health = scene.health.due(scene.now_us += kSecond_us).value();
  return std::ranges::find(health.gauges, "keyframes_built_anew", &gauge_t::name)->value;
}

TEST(Mapper, BuildsItsMapAnewOnlyWhereItIsNotThatOfItsKeyframes) {
  const TemporaryFolder folder;
  std::optional<WallScene> scene(folder.string());
  scene->request(map_request_t::WANT_MAP);
  scene->drive(1, {});
  scene->drive(2, {1.0, 0.0, 0.0});
  scene->service->stop();
  scene->drive(3, {2.0, 0.0, 0.0});
  const std::uint64_t map = scene->map.occupied.hash();
  for (const double anew : {1.0, 3.0}) {
    scene.reset();
    if (anew == 3.0) std::filesystem::resize_file(folder / mapping::kBuiltFile, 100);
    scene.emplace(folder.string());
    scene->request(map_request_t::WANT_MAP);
    EXPECT_EQ(built_anew(*scene), anew);
    EXPECT_EQ(scene->assembler.held()->version, 3);
    EXPECT_EQ(scene->map.occupied.hash(), map);
  }
}

// A map folder with keyframes at (0, 0) and (1, 0).
void make_map(const std::string& folder) {
  WallScene scene(folder);
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  scene.drive(2, {1.0, 0.0, 0.0});
}

TEST(Mapper, GivesUpReadingItsMapWhenItIsAskedToStop) {
  const TemporaryFolder folder;
  make_map(folder.string());
  service::stop_on_signals(false);
  std::raise(SIGTERM);
  EXPECT_THROW(WallScene(folder.string()), service::Stopped);
  service::stop_on_signals(false);
  WallScene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  EXPECT_EQ(scene.assembler.held()->version, 2);
}

TEST(Mapper, KeepsADamagedFileAsideAndGoesOnWithTheWholeKeyframes) {
  const TemporaryFolder folder;
  make_map(folder.string());
  const auto file = folder / mapping::kKeyframeFile;
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 3);
  WallScene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  EXPECT_EQ(scene.assembler.held()->version, 1);
  EXPECT_TRUE(std::filesystem::exists(folder / (std::string(mapping::kKeyframeFile) + ".damaged")));
  scene.drive(3, {2.0, 0.0, 0.0});
  EXPECT_TRUE(test::load_map(folder.string()).warning.empty());
}

TEST(Mapper, DoesNotStartInAFolderOfAnotherMapper) {
  const TemporaryFolder folder;
  const WallScene first(folder.string());
  EXPECT_THROW(WallScene(folder.string()), io::FileError);
}

TEST(Mapper, ServesAFolderThatItMustNotWriteAndWritesNothing) {
  const TemporaryFolder folder;
  make_map(folder / "map");
  std::filesystem::remove(folder / "map" / mapping::kMapLock);
  const auto before = std::filesystem::last_write_time(folder / "map");
  WallScene scene(folder / "map", false);
  scene.request(map_request_t::WANT_MAP);
  EXPECT_EQ(scene.assembler.held()->version, 2);
  scene.drive(3, {5.0, 0.0, 0.0});
  scene.request(map_request_t::WANT_SAVE);
  scene.service->stop();
  EXPECT_EQ(std::filesystem::last_write_time(folder / "map"), before);
  EXPECT_EQ(scene.health.state(), bus::Health::State::kOk) << scene.health.message();
}

TEST(Mapper, SaysThatThereIsNoMapToServe) {
  const TemporaryFolder folder;
  WallScene scene(folder / "none", false);
  EXPECT_EQ(scene.health.state(), bus::Health::State::kWarning);
  EXPECT_FALSE(std::filesystem::exists(folder / "none"));
}

class FolderGone : public testing::Test {
 protected:
  FolderGone() {
    scene_.request(map_request_t::WANT_MAP);
    scene_.drive(1, {});
    scene_.drive(2, {1.0, 0.0, 0.0});
  }

  // The mapper goes on in a fresh folder, which holds all that it ever had.
  void expect_recovery(const std::string& fresh) {
    scene_.now_us += kSecond_us;
    scene_.run();
    EXPECT_EQ(scene_.health.state(), bus::Health::State::kError);
    EXPECT_THAT(scene_.health.message(), testing::HasSubstr(fresh));
    EXPECT_EQ(test::load_map(folder_ / fresh).keyframes.size(), 2u);
    scene_.drive(3, {2.0, 0.0, 0.0});
    EXPECT_EQ(test::load_map(folder_ / fresh).keyframes.size(), 3u);
    EXPECT_EQ(test::load_map(folder_ / fresh).map_id, scene_.assembler.held()->map_id);
    EXPECT_NO_THROW(scene_.service->stop());
    EXPECT_TRUE(std::filesystem::exists(folder_ / fresh / "map.png"));
  }

  const TemporaryFolder folder_;
  const std::filesystem::path map_ = folder_ / "map";
  WallScene scene_{map_};
};

TEST_F(FolderGone, RemovedUnderTheMapper) {
  std::filesystem::remove_all(map_);
  expect_recovery("map.recovered-1");
  EXPECT_FALSE(std::filesystem::exists(map_));
}

TEST_F(FolderGone, ReplacedUnderTheMapper) {
  std::filesystem::rename(map_, folder_ / "old");
  make_map(map_);
  const std::string others = io::read_file(map_ / mapping::kKeyframeFile);
  expect_recovery("map.recovered-1");
  EXPECT_EQ(io::read_file(map_ / mapping::kKeyframeFile), others);
}

TEST_F(FolderGone, RemovedAgainAndAgain) {
  std::filesystem::remove_all(map_);
  scene_.now_us += kSecond_us;
  scene_.run();
  std::filesystem::rename(folder_ / "map.recovered-1", folder_ / "taken");
  std::filesystem::create_directory(folder_ / "map.recovered-1");
  expect_recovery("map.recovered-2");
}

// What could not be written is written when there is room, and the error ends.
TEST(Mapper, AFullDiskIsAnErrorForAsLongAsItLasts) {
  const TemporaryFolder folder;
  WallScene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  {
    const test::FileSizeLimit full(1000);
    scene.drive(2, {1.0, 0.0, 0.0});
    scene.drive(3, {2.0, 0.0, 0.0});
    EXPECT_EQ(scene.health.state(), bus::Health::State::kError);
    EXPECT_THROW(scene.service->stop(), std::runtime_error);
    EXPECT_EQ(test::load_map(folder.path()).keyframes.size(), 1u);
  }
  EXPECT_EQ(scene.assembler.held()->version, 3);
  scene.now_us += kSecond_us;
  scene.run();
  EXPECT_EQ(test::load_map(folder.path()).keyframes.size(), 3u);
  scene.service->stop();
  EXPECT_NE(scene.health.state(), bus::Health::State::kError) << scene.health.message();
}

TEST(Mapper, SaysThatItsLastSaveFailed) {
  const TemporaryFolder folder;
  WallScene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  std::filesystem::create_directories(folder / "map.png");
  EXPECT_THROW(scene.service->stop(), std::runtime_error);
}

}  // namespace
}  // namespace voxlist::services
