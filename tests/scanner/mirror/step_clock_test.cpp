#include "voxlist/scanner/mirror/step_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "voxlist/system/check.h"

namespace voxlist::scanner {
namespace {

constexpr std::int64_t kOrigin_us = 1'700'000'000'000'000;

// An even clock's edges from `first` to before `end`, through a stream.
struct Stream {
  double period_us = 5000.0, jitter_us = 200.0, lost = 0.0, doubled = 0.0;
  std::mt19937 random{7};

  void feed(StepClock& clock, std::int64_t first, std::int64_t end) {
    std::normal_distribution<double> jitter(0.0, jitter_us);
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    for (std::int64_t i = first; i < end; ++i) {
      if (chance(random) < lost) continue;
      for (int times = chance(random) < doubled ? 2 : 1; times > 0; --times)
        clock.add_edge(time_us(i) + std::llround(jitter(random)));
    }
  }
  std::int64_t time_us(std::int64_t edge) const {
    return kOrigin_us + std::llround(static_cast<double>(edge) * period_us);
  }
};

TEST(StepClock, MeasuresAnyPeriod) {
  for (const double period_us : {1000.0, 5000.0, 15000.0, 24000.0}) {
    StepClock clock;
    Stream stream{period_us, 0.04 * period_us};
    stream.feed(clock, 0, 10);
    EXPECT_FALSE(clock.ready());
    stream.feed(clock, 10, 1000);
    ASSERT_TRUE(clock.ready());
    EXPECT_NEAR(clock.period_us(), period_us, 2e-5 * period_us);
    EXPECT_NEAR(clock.steps_at(stream.time_us(999)), 999.0, 0.02);
    EXPECT_NEAR(static_cast<double>(clock.edge_us(990) - stream.time_us(990)), 0.0,
                0.02 * period_us);
  }
}

TEST(StepClock, CountsEdgesThatTheStreamLostAndLeavesOutDoubledOnes) {
  StepClock clock;
  Stream stream{.lost = 0.2, .doubled = 0.1};
  stream.feed(clock, 0, 20'000);
  const double steps = clock.steps_at(stream.time_us(20'000));
  EXPECT_NEAR(steps, std::round(steps), 0.05);
  EXPECT_NEAR(steps, 20'000.0, 1.1) << "but for a first edge that may be lost";
  EXPECT_NEAR(static_cast<double>(clock.counts().lost), 4000.0, 200.0);
  EXPECT_NEAR(static_cast<double>(clock.counts().doubled), 1600.0, 150.0);
  EXPECT_EQ(clock.counts().restarts, 0);
}

TEST(StepClock, LosesNothingOverADay) {
  StepClock clock;
  Stream stream;
  constexpr std::int64_t kDay = 86'400 * 200;
  stream.feed(clock, 0, kDay);
  EXPECT_NEAR(clock.steps_at(stream.time_us(kDay)), static_cast<double>(kDay), 0.03);
}

TEST(StepClock, CountsThroughAShortHole) {
  StepClock clock;
  Stream stream;
  stream.feed(clock, 0, 1000);
  stream.feed(clock, 1300, 1400);
  EXPECT_NEAR(clock.steps_at(stream.time_us(1400)), 1400.0, 0.05);
  EXPECT_EQ(clock.generation(), 0);
}

TEST(StepClock, StartsAnewAfterALongHoleAndWhenTimeGoesBack) {
  StepClock clock;
  Stream stream;
  stream.feed(clock, 10'000, 11'000);
  stream.feed(clock, 12'000, 12'100);
  EXPECT_EQ(clock.generation(), 1);
  stream.feed(clock, 0, 100);
  EXPECT_EQ(clock.generation(), 2);
  ASSERT_TRUE(clock.ready());
  EXPECT_NEAR(clock.steps_at(stream.time_us(99)), 99.0, 0.1);
}

TEST(StepClock, LearnsANewPeriod) {
  StepClock clock;
  Stream{.period_us = 15'000.0}.feed(clock, 0, 1000);
  Stream{.period_us = 24'000.0}.feed(clock, 626, 800);
  EXPECT_NEAR(clock.period_us(), 24'000.0, 50.0);
  Stream{.period_us = 5000.0}.feed(clock, 3841, 4100);
  EXPECT_NEAR(clock.period_us(), 5000.0, 20.0);
  EXPECT_EQ(clock.generation(), 2);
}

TEST(StepClock, RunsOnlyWhileEdgesCome) {
  StepClock clock;
  Stream stream;
  EXPECT_FALSE(clock.running(kOrigin_us));
  stream.feed(clock, 0, 100);
  EXPECT_TRUE(clock.running(stream.time_us(120)));
  EXPECT_FALSE(clock.running(stream.time_us(160)));
}

#if VOXLIST_CHECKS
TEST(StepClockDeathTest, IsNotAskedForStepsBeforeItsPeriodIsKnown) {
  EXPECT_DEATH(StepClock().steps_at(0), "before the period is known");
}
#endif

}  // namespace
}  // namespace voxlist::scanner
