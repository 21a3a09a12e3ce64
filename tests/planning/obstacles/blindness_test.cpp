#include "voxlist/planning/obstacles/blindness.h"

#include <gtest/gtest.h>

namespace voxlist::planning {
namespace {

constexpr std::int64_t kSlice_us = 66'667;

Cloud slice(std::int64_t utime_us, std::size_t points, float range_m = 2.0F) {
  Cloud cloud;
  cloud.utime_us = utime_us;
  cloud.points.assign(points, {range_m, 0.0F, 0.0F});
  return cloud;
}

// Slices as they come, until a time.
void feed(Blindness& blindness, std::int64_t from_us, std::int64_t to_us, std::size_t points,
          float range_m = 2.0F) {
  for (std::int64_t t_us = from_us; t_us <= to_us; t_us += kSlice_us)
    blindness.take(slice(t_us, points, range_m), t_us);
}

TEST(Blindness, IsThereUntilTheFirstCloud) {
  Blindness blindness(0.3);
  EXPECT_NE(blindness.why(0), "");
  blindness.take(slice(0, 300), 0);
  EXPECT_EQ(blindness.why(0), "");
}

TEST(Blindness, ComesThreeSlicesAfterTheLast) {
  Blindness blindness(0.3);
  feed(blindness, 0, 2'000'000, 300);
  EXPECT_EQ(blindness.why(2'200'000), "");
  EXPECT_NE(blindness.why(2'400'000), "");
}

TEST(Blindness, ComesThreeSweepsAfterTheLastWhereSweepsComeAlone) {
  Blindness blindness(0.3);
  for (std::int64_t t_us = 0; t_us <= 3'000'000; t_us += 1'000'000)
    blindness.take(slice(t_us, 5000), t_us);
  EXPECT_EQ(blindness.why(5'900'000), "");
  EXPECT_NE(blindness.why(6'100'000), "");
}

TEST(Blindness, SaysWhatTheMirrorSays) {
  Blindness blindness(0.3);
  feed(blindness, 0, 1'000'000, 300);
  blindness.take({.angle_known = false, .reason = "stalled"}, 1'000'000);
  EXPECT_NE(blindness.why(1'000'000).find("stalled"), std::string::npos);
  blindness.take({.angle_known = true, .reason = ""}, 1'010'000);
  EXPECT_EQ(blindness.why(1'010'000), "");
}

TEST(Blindness, IsACoveredLensThatMeetsItselfOrNothing) {
  for (const std::size_t points : {std::size_t{300}, std::size_t{0}}) {
    Blindness blindness(0.3);
    feed(blindness, 0, 2'000'000, 300);
    feed(blindness, 2'000'000, 4'000'000, points, 0.1F);
    EXPECT_NE(blindness.why(4'000'000).find("lens"), std::string::npos) << points;
  }
}

TEST(Blindness, IsNotASliceThatLooksUpIntoTheOpen) {
  Blindness blindness(0.3);
  for (int i = 0; i < 60; ++i) blindness.take(slice(i * kSlice_us, i % 15 < 5 ? 300 : 0), 0);
  EXPECT_EQ(blindness.why(0), "");
}

}  // namespace
}  // namespace voxlist::planning
