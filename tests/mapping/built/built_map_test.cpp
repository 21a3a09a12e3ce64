#include "voxlist/mapping/built/built_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"

namespace voxlist::mapping {
namespace {

namespace fs = std::filesystem;

constexpr int kKeyframes = 12;
constexpr MapBuilderConfig kCarved{.carve = true, .count_free = true};

// Rays to the walls of a room, which comes nearer: voids, waiting voxels, free space.
Keyframe room_from(int number) {
  Keyframe keyframe;
  keyframe.T_map_base = to_pose3({0.2 * number, 0.1, 0.05 * number});
  keyframe.cloud.utime_us = 1'000'000 + number;
  const double wall_m = number % 3 == 0 ? 3.0 : 4.0;
  for (int i = 0; i < 3000; ++i) {
    const double bearing = 0.0021 * i, up = 0.3 * std::sin(0.7 * i);
    keyframe.cloud.points.emplace_back(wall_m * std::cos(bearing), wall_m * std::sin(bearing), up);
  }
  return keyframe;
}

// A folder with keyframes, and what a map is built of there.
struct Folder {
  explicit Folder(int keyframes = kKeyframes, std::int64_t id = 42)
      : map_id(id), store(folder.path(), id, [](const Keyframe&) {}) {
    for (int i = 0; i < keyframes; ++i) append(room_from(i));
  }

  void append(const Keyframe& keyframe) {
    store.append(keyframe);
    poses.push_back({keyframe.cloud.utime_us, keyframe.T_map_base});
  }

  BuiltOf of(std::size_t keyframes = kKeyframes) {
    return {map_id, std::span(store.keyframes().places()).first(keyframes),
            std::span(poses).first(keyframes)};
  }

  MapBuilder fresh(const MapBuilderConfig& config = kCarved) {
    MapBuilder builder(config);
    add_stored(store.keyframes(), poses, builder, [] {});
    return builder;
  }

  // The same by what is in the file, and of how many keyframes that was.
  std::pair<MapBuilder, std::size_t> restored(const MapBuilderConfig& config = kCarved) {
    MapBuilder builder(config);
    const std::size_t built = read_built(folder.path(), of(poses.size()), builder);
    add_stored(store.keyframes(), poses, builder, [] {});
    return {std::move(builder), built};
  }

  fs::path file() const { return folder.path() / kBuiltFile; }

  test::TemporaryFolder folder;
  std::int64_t map_id;
  MapStore store;
  std::vector<StampedPose3> poses;
};

// All that a map's parts hold.
std::vector<std::uint64_t> bits_of(const MapBuilder& builder) {
  std::vector<std::uint64_t> bits{builder.map().occupied.hash(), builder.map().passed.hash(),
                                  builder.free_space().occupied.hash(),
                                  builder.free_space().passed.hash()};
  builder.visit_built([&](const auto& part) { bits.push_back(part.hash()); });
  return bits;
}

void flip(const fs::path& file, std::size_t at) {
  std::string bytes = io::read_file(file);
  bytes.at(at) = static_cast<char>(bytes.at(at) ^ 1);
  std::ofstream(file, std::ios::binary) << bytes;
}

class BuiltMapKinds : public testing::TestWithParam<MapBuilderConfig> {};

TEST_P(BuiltMapKinds, HasTheBitsOfOneThatIsMadeAnew) {
  Folder folder;
  const MapBuilder fresh = folder.fresh(GetParam());
  ASSERT_GT(fresh.map().occupied.size(), 1000u);
  write_built(folder.folder.path(), folder.of(), fresh);
  const auto [restored, built] = folder.restored(GetParam());
  EXPECT_EQ(built, std::size_t{kKeyframes});
  EXPECT_EQ(restored.poses().size(), fresh.poses().size());
  EXPECT_EQ(bits_of(restored), bits_of(fresh));
}

TEST_P(BuiltMapKinds, GrowsAsOneThatIsMadeAnew) {
  Folder folder;
  write_built(folder.folder.path(), folder.of(), folder.fresh(GetParam()));
  for (int i = kKeyframes; i < kKeyframes + 5; ++i) folder.append(room_from(i));
  const auto [restored, built] = folder.restored(GetParam());
  EXPECT_EQ(built, std::size_t{kKeyframes});
  EXPECT_EQ(restored.poses().size(), kKeyframes + 5u);
  EXPECT_EQ(bits_of(restored), bits_of(folder.fresh(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(Configs, BuiltMapKinds,
                         testing::Values(MapBuilderConfig{}, MapBuilderConfig{.count_free = true},
                                         kCarved));

TEST(BuiltMap, IsNotOfAKeyframeThatStandsElsewhere) {
  Folder folder;
  write_built(folder.folder.path(), folder.of(), folder.fresh());
  folder.poses[7].pose.translation().x() += 1e-9;
  EXPECT_EQ(folder.restored().second, 0u);
  EXPECT_EQ(bits_of(folder.restored().first), bits_of(folder.fresh()));
}

TEST(BuiltMap, IsNotOfOtherOrFewerKeyframes) {
  Folder folder, other(0), fewer(kKeyframes - 1);
  write_built(folder.folder.path(), folder.of(), folder.fresh());
  for (int i = 0; i < kKeyframes; ++i) {
    Keyframe keyframe = room_from(i);
    if (i == 7) keyframe.cloud.points[11].z() += 0.001f;
    other.append(keyframe);
  }
  for (Folder* const there : {&other, &fewer}) {
    fs::copy_file(folder.file(), there->file());
    EXPECT_EQ(there->restored().second, 0u);
    EXPECT_EQ(bits_of(there->restored().first), bits_of(there->fresh()));
  }
}

TEST(BuiltMap, IsNotOfAnotherMapOrOtherSettings) {
  Folder folder, other(kKeyframes, 43);
  write_built(folder.folder.path(), folder.of(), folder.fresh());
  fs::copy_file(folder.file(), other.file());
  EXPECT_EQ(other.restored().second, 0u);
  for (const MapBuilderConfig& config :
       {MapBuilderConfig{.count_free = true}, MapBuilderConfig{.carve = true},
        MapBuilderConfig{.max_range_m = 3.5, .carve = true, .count_free = true}})
    EXPECT_EQ(folder.restored(config).second, 0u);
  EXPECT_EQ(folder.restored({.min_news = 0.5, .carve = true, .count_free = true}).second,
            std::size_t{kKeyframes});
}

TEST(BuiltMap, IsNotReadWhereItIsTornOrFlipped) {
  Folder folder;
  const MapBuilder fresh = folder.fresh();
  write_built(folder.folder.path(), folder.of(), fresh);
  const std::string whole = io::read_file(folder.file());
  for (std::size_t at = 3; at < whole.size(); at += whole.size() / 17) {
    flip(folder.file(), at);
    const auto [flipped, none] = folder.restored();
    EXPECT_EQ(none, 0u) << "byte " << at << " of " << whole.size();
    EXPECT_EQ(bits_of(flipped), bits_of(fresh));
    std::ofstream(folder.file(), std::ios::binary) << whole.substr(0, at);
    EXPECT_EQ(folder.restored().second, 0u) << "cut at " << at << " of " << whole.size();
    std::ofstream(folder.file(), std::ios::binary) << whole;
  }
  std::ofstream(folder.file(), std::ios::binary) << whole << ' ';
  EXPECT_EQ(folder.restored().second, 0u);
}

}  // namespace
}  // namespace voxlist::mapping
