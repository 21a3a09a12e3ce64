#include "voxlist/bus/health.h"

#include <gtest/gtest.h>

#include <voxlist/health_t.hpp>

#include "voxlist/bus/wire.h"
#include "voxlist/system/version.h"

namespace voxlist::bus {
namespace {

TEST(Health, IsDueOnceASecond) {
  Health health("mapper");
  EXPECT_TRUE(health.due(5'000'000));
  EXPECT_FALSE(health.due(5'999'999));
  EXPECT_TRUE(health.due(6'000'000));
  EXPECT_TRUE(health.due(3)) << "the clock was set back";
}

TEST(Health, HasALastMessageWhateverIsDue) {
  Health health("mapper");
  ASSERT_TRUE(health.due(1'000'000));
  health.raise("stop", Health::State::kError, "no room");
  EXPECT_FALSE(health.due(1'000'001));
  EXPECT_EQ(health.last(1'000'001).message, "no room");
}

TEST(Health, TellsStateMessageAndCounters) {
  Health health("mapper");
  health.raise("clouds", Health::State::kWarning, "no clouds");
  health.count("late_cloud");
  health.count("late_cloud", 2);
  const auto message = health.due(7, {{"CLOUD/received", 5}});
  ASSERT_TRUE(message);
  EXPECT_EQ(message->utime, 7);
  EXPECT_EQ(message->service, "mapper");
  EXPECT_GT(message->pid, 0);
  EXPECT_EQ(message->state, health_t::STATE_WARNING);
  EXPECT_EQ(message->message, "no clouds");
  ASSERT_EQ(message->n_counters, 2);
  EXPECT_EQ(message->counters[0].name, "late_cloud");
  EXPECT_EQ(message->counters[0].count, 3);
  EXPECT_EQ(message->counters[1].name, "CLOUD/received");
  EXPECT_EQ(message->n_gauges, 0);
  EXPECT_EQ(message->version, version());
  EXPECT_EQ(check_lengths(*message), Fault::kNone);
}

TEST(Health, TellsAllConditionsTheWorstFirst) {
  Health health("mapper");
  health.raise("clouds", Health::State::kWarning, "no clouds");
  health.raise("disk", Health::State::kError, "the disk is full");
  health.raise("map", Health::State::kOk, "waits");
  EXPECT_EQ(health.state(), Health::State::kError);
  EXPECT_EQ(health.message(), "the disk is full; no clouds; waits");
  health.clear("disk");
  EXPECT_EQ(health.state(), Health::State::kWarning);
  EXPECT_EQ(health.message(), "no clouds; waits");
  health.clear("clouds");
  health.clear("map");
  EXPECT_EQ(health.state(), Health::State::kOk);
  EXPECT_EQ(health.message(), "");
}

TEST(Health, AConditionThatIsRaisedAgainReplacesItself) {
  Health health("mapper");
  health.raise("disk", Health::State::kError, "the disk is full");
  health.raise("disk", Health::State::kWarning, "the disk is nearly full");
  EXPECT_EQ(health.state(), Health::State::kWarning);
  EXPECT_EQ(health.message(), "the disk is nearly full");
  health.raise("disk", Health::State::kError, "");
  EXPECT_EQ(health.state(), Health::State::kOk) << "an empty sentence clears";
}

TEST(Health, TellsOneLineThatCanBeEncoded) {
  Health health("mapper");
  health.raise("disk", Health::State::kError, std::string("a\nb\0c", 5));
  EXPECT_EQ(health.message(), "a b c");
  EXPECT_EQ(check_lengths(*health.due(0)), Fault::kNone);
}

TEST(Health, TellsGaugesAsTheyAreNow) {
  Health health("mapper");
  health.gauge("memory_MB", 20.0);
  health.gauge("memory_MB", 21.5);
  const auto message = health.due(0);
  ASSERT_EQ(message->n_gauges, 1);
  EXPECT_EQ(message->gauges[0].name, "memory_MB");
  EXPECT_EQ(message->gauges[0].value, 21.5);
  EXPECT_EQ(check_lengths(*message), Fault::kNone);
}

TEST(Health, TellsTheLatenciesOfTheLastSecond) {
  Health health("mapper");
  for (int ms = 100; ms >= 1; --ms) health.add_latency_us(ms * 1000);
  auto message = health.due(0);
  ASSERT_TRUE(message);
  EXPECT_FLOAT_EQ(message->latency_p50_ms, 50.0F);
  EXPECT_FLOAT_EQ(message->latency_p99_ms, 99.0F);
  EXPECT_FLOAT_EQ(message->latency_max_ms, 100.0F);
  message = health.due(1'000'000);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->latency_p50_ms, -1.0F);
  EXPECT_EQ(message->latency_max_ms, -1.0F);
}

TEST(Health, KeepsTheMaximumOfMoreLatenciesThanItStores) {
  Health health("mapper");
  for (int i = 0; i < 20'000; ++i) health.add_latency_us(1000);
  health.add_latency_us(50'000);
  EXPECT_FLOAT_EQ(health.due(0)->latency_max_ms, 50.0F);
}

}  // namespace
}  // namespace voxlist::bus
