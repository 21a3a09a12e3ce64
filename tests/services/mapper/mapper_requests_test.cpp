#include <gtest/gtest.h>

#include <filesystem>
#include <voxlist/health_t.hpp>

#include "tests/services/mapper/wall_scene.h"
#include "tests/temporary_folder.h"

namespace voxlist::services {
namespace {

using test::TemporaryFolder;

TEST(Mapper, SendsKeyframesFromTheOneThatWasMissed) {
  const TemporaryFolder folder;
  WallScene scene(folder.string());
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
  WallScene scene(folder.string());
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
  WallScene scene(folder.string());
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
  WallScene scene(folder.string());
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
  WallScene scene(folder.string());
  scene.request(map_request_t::WANT_MAP);
  for (int i = 0; i < 4; ++i) scene.drive(i + 1, {double(i), 0.0, 0.0});
  scene.keyframes.clear();
  map_request_t message{};
  message.want = map_request_t::WANT_KEYFRAMES;
  for (int i = 0; i < 5; ++i) scene.bus.publish(bus::kMapRequest, message);
  scene.run();
  EXPECT_EQ(scene.keyframes.size(), 4u);
}

TEST(Mapper, TellsAtItsStartWhichMapItHas) {
  const TemporaryFolder folder;
  WallScene first(folder.string());
  first.run();
  ASSERT_EQ(first.updates.size(), 1u);
  EXPECT_TRUE(first.assembler.held()) << "an empty map is told whole";
  first.drive(1, {});
  first.service.reset();
  WallScene second(folder.string());
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
  WallScene scene(folder.string());
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
  WallScene scene(folder.string());
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
  WallScene scene(folder.string());
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

}  // namespace
}  // namespace voxlist::services
