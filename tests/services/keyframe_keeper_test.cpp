#include "services/mapper/keyframe_keeper.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "tests/file_size_limit.h"
#include "tests/stored_map.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/health.h"

namespace voxlist::services {
namespace {

using State = bus::Health::State;
using testing::HasSubstr;

mapping::Keyframe keyframe(int number, std::size_t points) {
  mapping::Keyframe keyframe;
  keyframe.cloud.utime_us = number;
  keyframe.T_map_base = to_pose3({double(number), 0.0, 0.0});
  keyframe.cloud.points.resize(points, {1.f + float(number), 0.f, 0.f});
  return keyframe;
}

// A keeper, and the map of its keyframes.
struct Scene {
  explicit Scene(const std::string& folder) : keeper(health, folder, true, 42, builder) {}

  void add(const mapping::Keyframe& k) { keeper.add(builder.add(k)); }
  void expect_all(std::size_t points) {
    for (std::size_t i = 0; i < builder.poses().size(); ++i) {
      EXPECT_EQ(keeper.read(i).cloud.utime_us, std::int64_t(i));
      EXPECT_EQ(keeper.read(i).cloud.points.size(), points);
    }
  }

  bus::Health health{"mapper"};
  mapping::MapBuilder builder;
  KeyframeKeeper keeper;
};

TEST(KeyframeKeeper, HandsOutWhatIsOnTheDiskAndWhatWaitsForIt) {
  const test::TemporaryFolder folder;
  Scene scene(folder.string());
  for (int i = 0; i < 3; ++i) scene.add(keyframe(i, 100));
  scene.expect_all(100);
  {
    const test::FileSizeLimit full(1000);
    for (int i = 3; i < 6; ++i) scene.add(keyframe(i, 100));
    EXPECT_EQ(scene.health.state(), State::kError);
    EXPECT_EQ(scene.keeper.size(), 6u);
    scene.expect_all(100);
  }
  scene.keeper.look_after();
  EXPECT_EQ(scene.health.state(), State::kOk);
  scene.expect_all(100);
  EXPECT_EQ(test::load_map(folder.path()).keyframes.size(), 6u);
}

// Clouds of 2.4 MB: the bound is far below what they would take in all.
TEST(KeyframeKeeper, HasNoRoomOnceTooMuchWaitsAndSaysSo) {
  Scene scene("");
  int added = 0;
  for (; scene.keeper.has_room() && added < 1000; ++added) scene.add(keyframe(added, 200'000));
  EXPECT_NEAR(added, KeyframeKeeper::kMostWaiting / 2'400'000, 1);
  EXPECT_EQ(scene.health.state(), State::kError);
  EXPECT_THAT(scene.health.message(), HasSubstr("the map does not grow"));
  scene.expect_all(200'000);
}

TEST(KeyframeKeeper, GivesThePoseOfAKeyframeThatTheDiskHasLost) {
  const test::TemporaryFolder folder;
  Scene scene(folder.string());
  for (int i = 0; i < 3; ++i) scene.add(keyframe(i, 100));
  const auto file = folder / mapping::kKeyframeFile;
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1);
  const mapping::Keyframe lost = scene.keeper.read(2);
  EXPECT_EQ(lost.cloud.utime_us, 2);
  EXPECT_EQ(lost.T_map_base.translation().x(), 2.0);
  EXPECT_TRUE(lost.cloud.points.empty());
  EXPECT_THAT(scene.health.message(), HasSubstr("keyframe 2 cannot be read back"));
  scene.keeper.look_after();
  const auto moved = test::load_map(folder.string() + ".recovered-1");
  EXPECT_EQ(moved.keyframes.size(), 3u);
  std::filesystem::remove_all(folder.string() + ".recovered-1");
}

}  // namespace
}  // namespace voxlist::services
