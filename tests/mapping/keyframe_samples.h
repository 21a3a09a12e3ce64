#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/stored_map.h"
#include "tests/temporary_folder.h"

namespace voxlist::mapping {

/// Keyframe `number` of a map: another place, time and count of points for each; every second one
/// with origins.
inline Keyframe keyframe(int number) {
  Keyframe keyframe;
  keyframe.T_map_base = to_pose3({0.5 * number, -0.25 * number, 0.1 * number});
  keyframe.cloud.utime_us = 1'000'000 * number;
  for (int i = 0; i < 5 + number % 4; ++i) {
    keyframe.cloud.points.emplace_back(0.1f * float(i), float(number), 1.f);
    if (number % 2) keyframe.cloud.origins.emplace_back(0.f, 0.01f * float(i), 0.6f);
  }
  return keyframe;
}

/// Which keyframes these are, each of them as keyframe() makes it.
inline std::vector<int> numbers_of(const std::vector<Keyframe>& keyframes) {
  std::vector<int> numbers;
  for (const Keyframe& found : keyframes) {
    numbers.push_back(static_cast<int>(found.cloud.utime_us / 1'000'000));
    const Keyframe expected = keyframe(numbers.back());
    EXPECT_EQ(found.cloud.utime_us, expected.cloud.utime_us);
    EXPECT_EQ(found.cloud.points, expected.cloud.points);
    EXPECT_EQ(found.cloud.origins, expected.cloud.origins);
    EXPECT_EQ(found.T_map_base.matrix().topRows<3>(), expected.T_map_base.matrix().topRows<3>());
  }
  return numbers;
}

inline std::vector<int> first_numbers(int count, int without = -1) {
  std::vector<int> numbers;
  for (int i = 0; i < count; ++i)
    if (i != without) numbers.push_back(i);
  return numbers;
}

/// Nothing to be done with what is read.
inline void ignore(const Keyframe&) {}

/// A map folder with the first keyframes, appended one by one; its id is 42.
inline std::filesystem::path make_map(const test::TemporaryFolder& folder, int keyframes) {
  MapStore store(folder / "map", 42, ignore);
  for (int i = 0; i < keyframes; ++i) store.append(keyframe(i));
  return folder / "map";
}

}  // namespace voxlist::mapping
