#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <optional>
#include <vector>
#include <voxlist/health_t.hpp>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pointcloud_t.hpp>

#include "services/mapper/mapper_service.h"
#include "tests/file_size_limit.h"
#include "tests/stored_map.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/maps/map_convert.h"
#include "voxlist/io/files/file.h"
#include "voxlist/service/stop.h"

namespace voxlist::services {
namespace {

using test::TemporaryFolder;

constexpr std::int64_t kSecond_us = 1'000'000;

Cloud cloud_at(std::int64_t utime_us) {
  Cloud cloud;
  cloud.utime_us = utime_us;
  for (int i = 0; i < 200; ++i) cloud.points.emplace_back(2.f, 0.03f * float(i), 0.5f);
  return cloud;
}

// The service with a folder, and a test that plays localiser and listeners.
struct Scene {
  explicit Scene(const std::string& folder, bool extend = true, TiltUse tilt = TiltUse::kPlanar) {
    MapperServiceConfig config;
    config.tilt = tilt;
    config.folder = folder;
    config.extend = extend;
    bus.subscribe(bus::kMapUpdate, [this](const map_update_t& m) { take(m); });
    bus.subscribe(bus::kKeyframe, [this](const keyframe_t& m) { keyframes.push_back(m); });
    service.emplace(bus, health, config);
  }

  void take(const map_update_t& message) {
    updates.push_back(message);
    for (const bus::MapChange& change : assembler.add(message)) bus::apply(change, map);
  }

  void run() {
    for (int i = 0; i < 3; ++i) {
      bus.handle(std::chrono::milliseconds(0));
      service->tick(now_us += 20'000);
    }
    bus.handle(std::chrono::milliseconds(0));
  }

  void request(std::int32_t want, std::int32_t first = 0) {
    map_request_t message{};
    message.want = want;
    message.first = first;
    bus.publish(bus::kMapRequest, message);
    run();
  }

  void request_new_map(std::int64_t map_id) {
    map_request_t message{};
    message.utime = now_us;
    message.want = map_request_t::WANT_NEW_MAP;
    message.map_id = map_id;
    bus.publish(bus::kMapRequest, message);
    run();
  }

  // A cloud, and what the localiser says of it.
  void drive(std::int64_t second, const Pose2& pose,
             std::int32_t state = localisation_t::STATE_TRACKING, const Tilt& tilt = {}) {
    bus.publish(bus::kCloud, bus::to_message(cloud_at(second * kSecond_us), "base", 0));
    localisation_t message{};
    message.utime = second * kSecond_us;
    message.map_id = assembler.held()->map_id;
    message.map_version = assembler.held()->version;
    message.state = state;
    message.n_modes = 1;
    message.modes.resize(1);
    message.modes[0].pose[0] = pose.x_m;
    message.modes[0].pose[1] = pose.y_m;
    message.modes[0].pose[2] = pose.yaw_rad;
    message.modes[0].tilt[0] = tilt.z_m;
    message.modes[0].tilt[1] = tilt.roll_rad;
    message.modes[0].tilt[2] = tilt.pitch_rad;
    bus.publish(bus::kLocalisation, message);
    run();
  }

  bus::Bus bus{{.url = "memq://", .prefix = ""}};
  bus::Health health{"mapper"};
  std::optional<MapperService> service;
  std::int64_t now_us = 1'700'000'000 * kSecond_us;
  bus::MapAssembler assembler;
  OccupancyMap map;
  std::vector<map_update_t> updates;
  std::vector<keyframe_t> keyframes;
};

TEST(Mapper, AnswersARequestWithTheEmptyMapThatItStartsFrom) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  ASSERT_TRUE(scene.assembler.held());
  EXPECT_EQ(scene.assembler.held()->version, 0);
}

TEST(Mapper, TellsInHealthHowLargeItsMapIs) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  scene.now_us += kSecond_us;
  scene.run();
  const health_t health = scene.health.last(scene.now_us);
  const auto voxels = std::ranges::find(health.gauges, "map_voxels", &gauge_t::name);
  ASSERT_NE(voxels, health.gauges.end());
  EXPECT_GT(voxels->value, 0.0);
  EXPECT_EQ(voxels->value, static_cast<double>(scene.map.occupied.size()));
}

TEST(Mapper, AddsSureCloudsThatMovedAndAnswersEveryLocalisation) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  EXPECT_EQ(scene.assembler.held()->version, 1);
  scene.drive(2, {0.1, 0.0, 0.0});
  EXPECT_EQ(scene.assembler.held()->version, 1);
  EXPECT_EQ(scene.assembler.held()->utime_us, 2 * kSecond_us);
  scene.drive(3, {1.0, 0.0, 0.0}, localisation_t::STATE_AMBIGUOUS);
  EXPECT_EQ(scene.assembler.held()->version, 1);
  scene.drive(4, {1.0, 0.0, 0.0});
  EXPECT_EQ(scene.assembler.held()->version, 2);

  mapping::MapBuilder expected;
  expected.add({to_pose3({}), cloud_at(1)});
  expected.add({to_pose3({1.0, 0.0, 0.0}), cloud_at(4)});
  EXPECT_EQ(scene.map.occupied.hash(), expected.map().occupied.hash());
  EXPECT_EQ(scene.map.passed.hash(), expected.map().passed.hash());
  EXPECT_GT(scene.map.passed.size(), 0u);
  ASSERT_EQ(scene.keyframes.size(), 2u);
  EXPECT_EQ(scene.keyframes[1].index, 1);
  EXPECT_EQ(scene.keyframes[1].utime, 4 * kSecond_us);
}

TEST(Mapper, PutsATiltedCloudIntoTheMapAsItIsWhereItIsToldTo) {
  const Tilt tilt{0.2, 0.05, -0.1};
  Scene scene("", true, TiltUse::kRefine);
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {}, localisation_t::STATE_TRACKING, tilt);
  ASSERT_EQ(scene.keyframes.size(), 1u);
  const Eigen::Quaterniond expected(to_level(tilt).linear());
  EXPECT_NEAR(scene.keyframes[0].trans[2], 0.2, 1e-9);
  EXPECT_NEAR(scene.keyframes[0].quat[1], expected.x(), 1e-9);
  EXPECT_NEAR(scene.keyframes[0].quat[2], expected.y(), 1e-9);
}

TEST(Mapper, LeavesATiltedCloudOutOfAMapOfLevelOnes) {
  Scene scene("");
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {}, localisation_t::STATE_TRACKING, {0.2, 0.05, -0.1});
  EXPECT_TRUE(scene.keyframes.empty());
  EXPECT_NE(scene.health.message().find("set tilt in [mapper]"), std::string::npos);
  scene.drive(2, {});
  EXPECT_EQ(scene.keyframes.size(), 1u);
}

TEST(Mapper, ADeadMappersMapIsThereAgainAtItsNextStart) {
  const TemporaryFolder folder;
  std::optional<Scene> first(folder.string());
  first->request(map_request_t::WANT_MAP);
  first->drive(1, {});
  first->drive(2, {1.0, 0.0, 0.0});
  const OccupancyMap map = first->map;
  const auto map_id = first->assembler.held()->map_id;
  first.reset();  // without stop(): as after kill -9

  Scene second(folder.string());
  second.request(map_request_t::WANT_MAP);
  EXPECT_EQ(second.assembler.held()->map_id, map_id);
  EXPECT_EQ(second.assembler.held()->version, 2);
  EXPECT_EQ(second.map.occupied.hash(), map.occupied.hash());
  EXPECT_EQ(second.map.passed.hash(), map.passed.hash());
  second.drive(3, {2.0, 0.0, 0.0});
  EXPECT_EQ(test::load_map(folder.string()).keyframes.size(), 3u);
}

// What the mapper says in HEALTH of so many keyframes that it has to add at its start.
double built_anew(Scene& scene) {
  const health_t health = scene.health.due(scene.now_us += kSecond_us).value();
  return std::ranges::find(health.gauges, "keyframes_built_anew", &gauge_t::name)->value;
}

TEST(Mapper, BuildsItsMapAnewOnlyWhereItIsNotThatOfItsKeyframes) {
  const TemporaryFolder folder;
  std::optional<Scene> scene(folder.string());
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

TEST(Mapper, SendsKeyframesFromTheOneThatWasMissed) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  for (int i = 0; i < 4; ++i) scene.drive(i + 1, {double(i), 0.0, 0.0});
  scene.keyframes.clear();
  scene.request(map_request_t::WANT_KEYFRAMES, 2);
  ASSERT_EQ(scene.keyframes.size(), 2u);
  EXPECT_EQ(scene.keyframes[0].index, 2);
  scene.request(map_request_t::WANT_KEYFRAMES, -5);
  EXPECT_EQ(scene.keyframes.size(), 6u);
}

TEST(Mapper, SendsSomeKeyframesForOneRequestAtMost) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  const int many = bus::kKeyframesAtOnce + 5;
  for (int i = 0; i < many; ++i) scene.drive(i + 1, {double(i), 0.0, 0.0});
  scene.keyframes.clear();
  scene.request(map_request_t::WANT_KEYFRAMES, 2);
  ASSERT_EQ(scene.keyframes.size(), std::size_t(bus::kKeyframesAtOnce));
  EXPECT_EQ(scene.keyframes.back().index, bus::kKeyframesAtOnce + 1);
}

TEST(Mapper, WritesTheMapsViewsOnCommandAndOnStop) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  scene.request(map_request_t::WANT_SAVE);
  EXPECT_TRUE(std::filesystem::exists(folder / "map.png"));
  std::filesystem::remove(folder / "map.png");
  scene.service->stop();
  for (const char* file : {"map.png", "map.ply", "trajectory.tum"})
    EXPECT_TRUE(std::filesystem::exists(folder / file));
}

TEST(Mapper, SavesOncePerSecondHoweverOftenItIsAsked) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  const auto count = [&] {  // a minute later: a save that takes long puts the next one off
    const auto health = scene.health.due(scene.now_us += 60 * kSecond_us);
    for (const counter_t& counter : health->counters)
      if (counter.name == "saved") return counter.count;
    return std::int64_t{0};
  };
  for (int i = 0; i < 5; ++i) scene.request(map_request_t::WANT_SAVE);
  EXPECT_EQ(count(), 1);
  scene.run();
  EXPECT_EQ(count(), 2) << "what was asked for in between is not forgotten";
  scene.run();
  EXPECT_EQ(count(), 2);
}

TEST(Mapper, SendsKeyframesOnceWhenManyAskAtOnce) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  for (int i = 0; i < 4; ++i) scene.drive(i + 1, {double(i), 0.0, 0.0});
  scene.keyframes.clear();
  map_request_t message{};
  message.want = map_request_t::WANT_KEYFRAMES;
  for (int i = 0; i < 5; ++i) scene.bus.publish(bus::kMapRequest, message);
  scene.run();
  EXPECT_EQ(scene.keyframes.size(), 4u);
}

TEST(Mapper, LeavesItsMapAndFileAsTheyAreWhileItIsToldTo) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  const auto file = folder.path() / mapping::kKeyframeFile;
  const std::string before = io::read_file(file);
  scene.request(map_request_t::WANT_LOCALISE_ONLY);
  scene.drive(2, {1.0, 0.0, 0.0});
  scene.drive(3, {2.0, 0.0, 0.0});
  EXPECT_EQ(scene.updates.back().version, 1);
  EXPECT_EQ(scene.updates.back().utime, 3 * kSecond_us) << "each is answered all the same";
  EXPECT_EQ(io::read_file(file), before);
  scene.request(map_request_t::WANT_EXTEND);
  scene.drive(4, {3.0, 0.0, 0.0});
  EXPECT_EQ(scene.updates.back().version, 2);
  EXPECT_GT(io::read_file(file).size(), before.size());
}

TEST(Mapper, ExtendsNoMapThatItMustNotWriteWhoeverAsks) {
  const TemporaryFolder folder;
  {
    Scene scene(folder.string());
    scene.request(map_request_t::WANT_MAP);
    scene.drive(1, {});
  }
  Scene scene(folder.string(), false);
  scene.request(map_request_t::WANT_MAP);
  scene.request(map_request_t::WANT_EXTEND);
  scene.drive(2, {5.0, 0.0, 0.0});
  EXPECT_EQ(scene.assembler.held()->version, 1);
}

TEST(Mapper, OnlyServesItsMapWhenItIsNotToExtendIt) {
  const TemporaryFolder folder;
  {
    Scene scene(folder.string());
    scene.request(map_request_t::WANT_MAP);
    scene.drive(1, {});
  }
  Scene scene(folder.string(), false);
  scene.request(map_request_t::WANT_MAP);
  scene.drive(2, {5.0, 0.0, 0.0});
  EXPECT_EQ(scene.assembler.held()->version, 1);
  EXPECT_EQ(scene.assembler.held()->utime_us, 2 * kSecond_us);
}

// A map folder with keyframes at (0, 0) and (1, 0).
void make_map(const std::string& folder) {
  Scene scene(folder);
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  scene.drive(2, {1.0, 0.0, 0.0});
}

TEST(Mapper, GivesUpReadingItsMapWhenItIsAskedToStop) {
  const TemporaryFolder folder;
  make_map(folder.string());
  service::stop_on_signals(false);
  std::raise(SIGTERM);
  EXPECT_THROW(Scene(folder.string()), service::Stopped);
  service::stop_on_signals(false);
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  EXPECT_EQ(scene.assembler.held()->version, 2);
}

TEST(Mapper, KeepsADamagedFileAsideAndGoesOnWithTheWholeKeyframes) {
  const TemporaryFolder folder;
  make_map(folder.string());
  const auto file = folder / mapping::kKeyframeFile;
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 3);
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  EXPECT_EQ(scene.assembler.held()->version, 1);
  EXPECT_TRUE(std::filesystem::exists(folder / (std::string(mapping::kKeyframeFile) + ".damaged")));
  scene.drive(3, {2.0, 0.0, 0.0});
  EXPECT_TRUE(test::load_map(folder.string()).warning.empty());
}

TEST(Mapper, DoesNotStartInAFolderOfAnotherMapper) {
  const TemporaryFolder folder;
  const Scene first(folder.string());
  EXPECT_THROW(Scene(folder.string()), io::FileError);
}

TEST(Mapper, ServesAFolderThatItMustNotWriteAndWritesNothing) {
  const TemporaryFolder folder;
  make_map(folder / "map");
  std::filesystem::remove(folder / "map" / mapping::kMapLock);
  const auto before = std::filesystem::last_write_time(folder / "map");
  Scene scene(folder / "map", false);
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
  Scene scene(folder / "none", false);
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
  Scene scene_{map_};
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
  Scene scene(folder.string());
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
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  std::filesystem::create_directories(folder / "map.png");
  EXPECT_THROW(scene.service->stop(), std::runtime_error);
}

TEST(Mapper, HearsAnotherMapperOnItsBus) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  health_t message{};
  message.service = "mapper";
  message.pid = ::getpid();
  scene.bus.publish(bus::kHealth, message);
  scene.run();
  EXPECT_NE(scene.health.state(), bus::Health::State::kError);
  message.pid = 1;
  scene.bus.publish(bus::kHealth, message);
  scene.run();
  EXPECT_EQ(scene.health.state(), bus::Health::State::kError);
  EXPECT_THAT(scene.health.message(), testing::HasSubstr("process 1"));
  scene.now_us += 4 * kSecond_us;
  scene.run();
  EXPECT_NE(scene.health.state(), bus::Health::State::kError) << scene.health.message();
}

TEST(Mapper, TellsAtItsStartWhichMapItHas) {
  const TemporaryFolder folder;
  Scene first(folder.string());
  first.run();
  ASSERT_EQ(first.updates.size(), 1u);
  EXPECT_TRUE(first.assembler.held()) << "an empty map is told whole";
  first.drive(1, {});
  first.service.reset();
  Scene second(folder.string());
  second.run();
  second.run();
  ASSERT_EQ(second.updates.size(), 1u);
  EXPECT_EQ(second.updates[0].map_id, first.updates[0].map_id);
  EXPECT_EQ(second.updates[0].version, 1);
  EXPECT_EQ(second.updates[0].n_blocks, 0);
  EXPECT_EQ(second.updates[0].answers, 0);
}

TEST(Mapper, TellsItsMapToALocaliserInAnother) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  const auto map_id = scene.updates.back().map_id;
  scene.updates.clear();
  for (int i = 0; i < 20; ++i) {
    localisation_t message{};
    message.utime = (2 + i) * kSecond_us;
    message.map_id = map_id + 1;
    scene.bus.publish(bus::kLocalisation, message);
  }
  scene.run();
  ASSERT_EQ(scene.updates.size(), 1u) << "however many come at once";
  EXPECT_EQ(scene.updates[0].map_id, map_id);
  EXPECT_EQ(scene.updates[0].version, 1);
}

TEST(Mapper, AnswersEachRequestWithItsIdAndVersion) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  for (const std::int32_t want : std::initializer_list<std::int32_t>{1, 2, 77}) {
    scene.updates.clear();
    map_request_t message{};
    message.utime = 1234 + want;
    message.want = want;
    scene.bus.publish(bus::kMapRequest, message);
    scene.run();
    ASSERT_EQ(scene.updates.size(), 1u);
    EXPECT_EQ(scene.updates[0].answers, 1234 + want);
    EXPECT_EQ(scene.updates[0].version, 1);
  }
}

TEST(Mapper, SendsTheMapToWhoHasNoneOrAnotherVersionOfIt) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  const auto map_id = scene.updates.back().map_id;
  const auto sends_map = [&](std::int64_t id, std::int64_t version) {
    scene.updates.clear();
    map_request_t message{};
    message.map_id = id;
    message.version = version;
    scene.bus.publish(bus::kMapRequest, message);
    scene.run();
    return scene.updates.back().n_blocks > 0;
  };
  EXPECT_TRUE(sends_map(0, 0));
  EXPECT_TRUE(sends_map(map_id, 0));
  EXPECT_TRUE(sends_map(map_id, 2));
  EXPECT_FALSE(sends_map(map_id, 1));
  EXPECT_FALSE(sends_map(map_id + 1, 1)) << "first it has to drop that";
}

TEST(Mapper, AddsNoPoseOfAnotherVersionOfItsMap) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  for (const std::int64_t version : {0, 2}) {
    scene.bus.publish(bus::kCloud, bus::to_message(cloud_at(version + 2), "base", 0));
    localisation_t message{};
    message.utime = version + 2;
    message.map_id = scene.assembler.held()->map_id;
    message.map_version = version;
    message.state = localisation_t::STATE_TRACKING;
    message.n_modes = 1;
    message.modes.resize(1);
    message.modes[0].pose[0] = 9.0;
    scene.bus.publish(bus::kLocalisation, message);
    scene.run();
    EXPECT_EQ(scene.assembler.held()->version, 1);
    EXPECT_EQ(scene.updates.back().utime, version + 2) << "the localiser waits for an answer";
  }
}

TEST(Mapper, GivesUpAMapWhoseOnlyCloudNoOtherFits) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  scene.drive(2, {}, localisation_t::STATE_LOST);
  const std::int64_t id = scene.assembler.held()->map_id;
  scene.request_new_map(id);
  scene.request(map_request_t::WANT_MAP);
  EXPECT_NE(scene.updates.back().map_id, id);
  EXPECT_EQ(scene.updates.back().version, 0);
  EXPECT_NE(scene.health.message().find("first cloud was given up"), std::string::npos);

  scene.drive(3, {});
  EXPECT_EQ(scene.assembler.held()->version, 1);
  scene.drive(4, {1.0, 0.0, 0.0});
  EXPECT_EQ(scene.health.message(), "");
  scene.service.reset();
  const test::StoredMap stored = test::load_map(folder.string());
  ASSERT_EQ(stored.keyframes.size(), 2u);
  EXPECT_EQ(stored.keyframes[0].cloud.utime_us, 3 * kSecond_us);
  EXPECT_EQ(stored.warning, "");
  EXPECT_TRUE(std::filesystem::exists(folder / "keyframes.voxlist.given-up"));
}

TEST(Mapper, GivesUpNoMapThatASecondCloudFitsOrThatItOnlyServes) {
  const TemporaryFolder folder;
  std::int64_t id = 0;
  {
    Scene scene(folder.string());
    scene.request(map_request_t::WANT_MAP);
    scene.drive(1, {});
    id = scene.assembler.held()->map_id;
    scene.request_new_map(id + 1);
    EXPECT_EQ(scene.updates.back().map_id, id) << "it was asked about another map";
    scene.drive(2, {0.1, 0.0, 0.0});
    scene.request_new_map(id);
    EXPECT_EQ(scene.updates.back().map_id, id) << "a second cloud was placed in it";
    EXPECT_EQ(scene.updates.back().version, 1);
  }
  Scene serving(folder.string(), false);
  serving.request_new_map(id);
  EXPECT_EQ(serving.updates.back().map_id, id);
  EXPECT_EQ(test::load_map(folder.string()).keyframes.size(), 1u);
}

TEST(Mapper, DecidesOnACloudOnce) {
  const TemporaryFolder folder;
  Scene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {});
  scene.drive(2, {0.1, 0.0, 0.0});
  localisation_t forged{};
  forged.utime = 2 * kSecond_us;
  forged.map_id = scene.assembler.held()->map_id;
  forged.map_version = 1;
  forged.state = localisation_t::STATE_TRACKING;
  forged.n_modes = 1;
  forged.modes.resize(1);
  forged.modes[0].pose[0] = 5.0;
  scene.bus.publish(bus::kLocalisation, forged);
  scene.run();
  EXPECT_EQ(scene.assembler.held()->version, 1);
}

}  // namespace
}  // namespace voxlist::services
