#include "voxlist/mapping/map_store.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <fstream>
#include <functional>
#include <random>

#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"

namespace voxlist::mapping {
namespace {

using test::TemporaryFolder;

Keyframe keyframe(int number) {
  Keyframe keyframe;
  keyframe.T_map_base = to_pose3({0.5 * number, -0.25 * number, 0.1 * number});
  keyframe.cloud.utime_us = 1'000'000 * number;
  for (int i = 0; i < 10 * (number + 1); ++i) {
    keyframe.cloud.points.emplace_back(0.1f * float(i), float(number), 1.f);
    if (number % 2) keyframe.cloud.origins.emplace_back(0.f, 0.01f * float(i), 0.6f);
  }
  return keyframe;
}

void expect_keyframes(const StoredMap& stored, const std::vector<int>& numbers) {
  ASSERT_EQ(stored.keyframes.size(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Keyframe expected = keyframe(numbers[i]);
    EXPECT_EQ(stored.keyframes[i].cloud.utime_us, expected.cloud.utime_us);
    EXPECT_EQ(stored.keyframes[i].cloud.points, expected.cloud.points);
    EXPECT_EQ(stored.keyframes[i].cloud.origins, expected.cloud.origins);
    EXPECT_EQ(stored.keyframes[i].T_map_base.matrix().topRows<3>(),
              expected.T_map_base.matrix().topRows<3>());
  }
}

std::filesystem::path store(const TemporaryFolder& folder, int keyframes) {
  MapStore store(folder / "map", 42, {});
  for (int i = 0; i < keyframes; ++i) store.append(keyframe(i));
  return folder / "map";
}

TEST(MapStore, GivesBackWhatWasAppended) {
  const TemporaryFolder folder;
  const StoredMap stored = load_map(store(folder, 4));
  EXPECT_EQ(stored.map_id, 42);
  EXPECT_TRUE(stored.warning.empty());
  expect_keyframes(stored, {0, 1, 2, 3});
}

TEST(MapStore, GoesOnWhereItStopped) {
  const TemporaryFolder folder;
  const auto map = store(folder, 2);
  MapStore(map).append(keyframe(2));
  expect_keyframes(load_map(map), {0, 1, 2});
}

TEST(MapStore, ProtectsRecordsByTheChecksumThatFilesHaveToday) {
  const TemporaryFolder folder;
  const std::string bytes = io::read_file(store(folder, 1) / kKeyframeFile);
  ASSERT_EQ(bytes.size(), 16U + 8U + 112U + 10U * 12U);
  EXPECT_EQ(bytes.substr(20, 4), "\x95($*");
}

TEST(MapStore, LosesAtMostTheTornRecord) {
  const TemporaryFolder folder;
  const auto map = store(folder, 3);
  const auto file = map / kKeyframeFile;
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 7);
  const StoredMap stored = load_map(map);
  EXPECT_FALSE(stored.warning.empty());
  expect_keyframes(stored, {0, 1});
}

TEST(MapStore, LeavesOutARecordWithAFlippedBitAndKeepsTheOthers) {
  const TemporaryFolder folder;
  const auto map = store(folder, 3);
  std::string bytes = io::read_file(map / kKeyframeFile);
  bytes[16 + 8 + 40] ^= 1;
  std::ofstream(map / kKeyframeFile, std::ios::binary) << bytes;
  expect_keyframes(load_map(map), {1, 2});
}

// A cut or a few changed bytes, both, or neither.
std::string damaged(const std::string& whole, std::mt19937& random) {
  std::string bytes = whole.substr(0, random() % 3 ? whole.size() : random() % whole.size());
  for (unsigned flips = random() % 4; flips > 0 && !bytes.empty(); --flips)
    bytes[random() % bytes.size()] = static_cast<char>(random());
  return bytes;
}

std::ptrdiff_t undamaged_bytes(const std::string& whole, const std::string& bytes) {
  return std::mismatch(whole.begin(), whole.end(), bytes.begin(), bytes.end()).first -
         whole.begin();
}

// Which keyframes were read; each is what was appended.
std::vector<int> numbers_of(const StoredMap& stored) {
  std::vector<int> numbers;
  for (const Keyframe& keyframe : stored.keyframes)
    numbers.push_back(static_cast<int>(keyframe.cloud.utime_us / 1'000'000));
  expect_keyframes(stored, numbers);
  return numbers;
}

TEST(MapStore, KeepsWhatIsWholeBeforeAnyDamageAndInventsNothing) {
  constexpr std::ptrdiff_t kMagic = 8, kHeader = 16;
  const TemporaryFolder folder;
  std::array<std::ptrdiff_t, 3> ends{};
  for (int i = 0; i < 3; ++i)
    ends[static_cast<std::size_t>(i)] = static_cast<std::ptrdiff_t>(
        std::filesystem::file_size(store(folder, i + 1) / kKeyframeFile));
  const auto map = folder / "map";
  const std::string whole = io::read_file(map / kKeyframeFile);
  std::mt19937 random(5);
  int refused = 0, kept_behind_damage = 0;
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(i);
    const std::string bytes = damaged(whole, random);
    const std::ptrdiff_t undamaged = undamaged_bytes(whole, bytes);
    std::ofstream(map / kKeyframeFile, std::ios::binary) << bytes;
    if (undamaged < kMagic || std::ssize(bytes) < kHeader) {
      EXPECT_THROW(load_map(map), io::FileError);
      ++refused;
      continue;
    }
    const StoredMap stored = load_map(map);
    const std::vector<int> numbers = numbers_of(stored);
    const auto before =
        std::count_if(ends.begin(), ends.end(), [&](auto end) { return end <= undamaged; });
    ASSERT_GE(std::ssize(numbers), before);
    for (int k = 0; k < before; ++k) EXPECT_EQ(numbers[static_cast<std::size_t>(k)], k);
    EXPECT_EQ(std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<>()),
              numbers.end());
    EXPECT_TRUE(numbers.size() == 3 || !stored.warning.empty() || std::ssize(bytes) == kHeader ||
                std::find(ends.begin(), ends.end(), std::ssize(bytes)) != ends.end());
    kept_behind_damage += std::ssize(numbers) > before;
  }
  EXPECT_GT(refused, 20);
  EXPECT_GT(kept_behind_damage, 200);
}

TEST(MapStore, AFullDiskLeavesTheFileAsItWas) {
  const TemporaryFolder folder;
  const auto map = store(folder, 2);
  MapStore store(map);
  const auto size = std::filesystem::file_size(map / kKeyframeFile);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const rlimit full{size + 20, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &full);
  EXPECT_THROW(store.append(keyframe(2)), io::FileError);
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(std::filesystem::file_size(map / kKeyframeFile), size);
  store.append(keyframe(2));
  expect_keyframes(load_map(map), {0, 1, 2});
}

TEST(MapStore, SaysWhatIsNoMap) {
  const TemporaryFolder folder;
  EXPECT_THROW(load_map(folder / "none"), io::FileError);
  std::ofstream(folder / kKeyframeFile) << "something else entirely";
  EXPECT_THROW(load_map(folder.string()), io::FileError);
}

}  // namespace
}  // namespace voxlist::mapping
