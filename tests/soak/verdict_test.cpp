#include "tests/soak/verdict.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>

#include "tests/soak/laps.h"

namespace voxlist::soak {
namespace {

constexpr std::size_t kHour = 60;

// Minutes of one service and its memory: `MB_of(minute)`.
template <class MegabytesOf>
std::vector<Minute> minutes_with(std::size_t minutes, MegabytesOf MB_of) {
  std::vector<Minute> all(minutes);
  for (std::size_t i = 0; i < minutes; ++i) {
    all[i].answers.tracking = 60;
    all[i].services["mapper"].healths = 1;
    all[i].services["mapper"].memory_MB = MB_of(static_cast<double>(i));
  }
  return all;
}

bool all_kept(const std::vector<Minute>& minutes) {
  return std::ranges::all_of(judge(minutes), &Check::is_kept);
}

TEST(Soak, MemoryMayGrowInTheFirstHourAlone) {
  const auto learns = [](double minute) { return minute < 60.0 ? 10.0 + minute : 70.0; };
  EXPECT_TRUE(all_kept(minutes_with(4 * kHour, learns)));
}

TEST(Soak, MemoryThatGrowsByTwoPercentAnHourFails) {
  const auto leaks = [](double minute) { return 100.0 + minute / 30.0; };
  const auto minutes = minutes_with(4 * kHour, leaks);
  EXPECT_FALSE(all_kept(minutes));
  std::vector<double> memory_MB;
  for (const Minute& minute : minutes) memory_MB.push_back(minute.services.at("mapper").memory_MB);
  EXPECT_NEAR(growth_percent_per_hour(memory_MB).value(), 2.0, 0.1);
  memory_MB.resize(3 * kHour - 1);
  EXPECT_FALSE(growth_percent_per_hour(memory_MB));
}

TEST(Soak, OneFaultFailsTheRun) {
  const auto flat = [](double) { return 10.0; };
  EXPECT_TRUE(all_kept(minutes_with(2, flat)));
  EXPECT_FALSE(all_kept(minutes_with(0, flat)));
  auto minutes = minutes_with(2, flat);
  minutes[1].answers.wrong = 1;
  EXPECT_FALSE(all_kept(minutes));
  minutes = minutes_with(2, flat);
  minutes[0].services["mapper"].restarts = 1;
  EXPECT_FALSE(all_kept(minutes));
  minutes = minutes_with(2, flat);
  minutes[0].answers.unanswered = 1;
  EXPECT_FALSE(all_kept(minutes));
  minutes = minutes_with(2, flat);
  minutes[1].services["mapper"].lost["CLOUD/truncated"] = 1;
  EXPECT_FALSE(all_kept(minutes));
}

health_t health(std::int32_t pid, std::int64_t truncated) {
  health_t message{};
  message.pid = pid;
  message.counters = {{"CLOUD/handled", 100}, {"CLOUD/truncated", truncated}};
  return message;
}

TEST(Soak, LossesAndRestartsAreThoseSinceTheLastLook) {
  Watch watch;
  watch.take(health(getpid(), 2));
  EXPECT_THAT(watch.since_last().lost, testing::ElementsAre(testing::Pair("CLOUD/truncated", 2)));
  watch.take(health(getpid(), 2));
  watch.take(health(getppid(), 1));
  const ServiceTime time = watch.since_last();
  EXPECT_EQ(time.restarts, 1);
  EXPECT_THAT(time.lost, testing::ElementsAre(testing::Pair("CLOUD/truncated", 1)));
}

TEST(Soak, TruthIsInterpolated) {
  RecentTruth truth;
  truth.add(1'000'000, {0.0, 0.0, 0.0});
  truth.add(2'000'000, {2.0, 0.0, 0.0});
  EXPECT_NEAR(truth.at(1'500'000).x_m, 1.0, 1e-9);
  EXPECT_EQ(truth.at(3'000'000).x_m, 2.0);
}

// Lines are evenly apart and odometry does not jump where one lap ends and the next begins.
TEST(Soak, LapsFollowEachOtherWithoutAGap) {
  Laps laps({.rooms = 1, .people = 0});
  std::int64_t line_us = -1, longest_us = 0, lines = 0;
  std::optional<Pose2> pose;
  double longest_m = 0.0;
  while (line_us < 200'000'000) {
    const simulation::SimulatedEvent event = laps.next();
    if (const auto* line = std::get_if<LaserLine>(&event)) {
      if (lines++ > 0) longest_us = std::max(longest_us, line->utime_us - line_us);
      line_us = line->utime_us;
    } else if (const auto* odometry = std::get_if<simulation::SimulatedOdometry>(&event)) {
      if (pose) longest_m = std::max(longest_m, distance_m(*pose, odometry->measured.pose));
      pose = odometry->measured.pose;
    }
  }
  EXPECT_EQ(lines, 200 * 75 + 1);
  EXPECT_LE(longest_us, 13'334);
  EXPECT_LT(longest_m, 0.1);
  EXPECT_GT(laps.done(), 1);
}

}  // namespace
}  // namespace voxlist::soak
