#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <voxlist/health_t.hpp>

#include "tests/services/mapper/wall_scene.h"
#include "tests/stored_map.h"
#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"

namespace voxlist::services {
namespace {

using test::TemporaryFolder;

TEST(Mapper, AnswersARequestWithTheEmptyMapThatItStartsFrom) {
  const TemporaryFolder folder;
  WallScene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  ASSERT_TRUE(scene.assembler.held());
  EXPECT_EQ(scene.assembler.held()->version, 0);
}

TEST(Mapper, TellsInHealthHowLargeItsMapIs) {
  const TemporaryFolder folder;
  WallScene scene(folder.string());
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
  WallScene scene(folder.string());
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
  WallScene scene("", true, TiltUse::kRefine);
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {}, localisation_t::STATE_TRACKING, tilt);
  ASSERT_EQ(scene.keyframes.size(), 1u);
  const Eigen::Quaterniond expected(to_level(tilt).linear());
  EXPECT_NEAR(scene.keyframes[0].trans[2], 0.2, 1e-9);
  EXPECT_NEAR(scene.keyframes[0].quat[1], expected.x(), 1e-9);
  EXPECT_NEAR(scene.keyframes[0].quat[2], expected.y(), 1e-9);
}

TEST(Mapper, LeavesATiltedCloudOutOfAMapOfLevelOnes) {
  WallScene scene("");
  scene.request(map_request_t::WANT_MAP);
  scene.drive(1, {}, localisation_t::STATE_TRACKING, {0.2, 0.05, -0.1});
  EXPECT_TRUE(scene.keyframes.empty());
  EXPECT_NE(scene.health.message().find("set tilt in [mapper]"), std::string::npos);
  scene.drive(2, {});
  EXPECT_EQ(scene.keyframes.size(), 1u);
}

TEST(Mapper, LeavesItsMapAndFileAsTheyAreWhileItIsToldTo) {
  const TemporaryFolder folder;
  WallScene scene(folder.string());
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
    WallScene scene(folder.string());
    scene.request(map_request_t::WANT_MAP);
    scene.drive(1, {});
  }
  WallScene scene(folder.string(), false);
  scene.request(map_request_t::WANT_MAP);
  scene.request(map_request_t::WANT_EXTEND);
  scene.drive(2, {5.0, 0.0, 0.0});
  EXPECT_EQ(scene.assembler.held()->version, 1);
}

TEST(Mapper, OnlyServesItsMapWhenItIsNotToExtendIt) {
  const TemporaryFolder folder;
  {
    WallScene scene(folder.string());
    scene.request(map_request_t::WANT_MAP);
    scene.drive(1, {});
  }
  WallScene scene(folder.string(), false);
  scene.request(map_request_t::WANT_MAP);
  scene.drive(2, {5.0, 0.0, 0.0});
  EXPECT_EQ(scene.assembler.held()->version, 1);
  EXPECT_EQ(scene.assembler.held()->utime_us, 2 * kSecond_us);
}

TEST(Mapper, HearsAnotherMapperOnItsBus) {
  const TemporaryFolder folder;
  WallScene scene(folder.string());
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

TEST(Mapper, AddsNoPoseOfAnotherVersionOfItsMap) {
  const TemporaryFolder folder;
  WallScene scene(folder.string());
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
  WallScene scene(folder.string());
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
    WallScene scene(folder.string());
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
  WallScene serving(folder.string(), false);
  serving.request_new_map(id);
  EXPECT_EQ(serving.updates.back().map_id, id);
  EXPECT_EQ(test::load_map(folder.string()).keyframes.size(), 1u);
}

TEST(Mapper, DecidesOnACloudOnce) {
  const TemporaryFolder folder;
  WallScene scene(folder.string());
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
