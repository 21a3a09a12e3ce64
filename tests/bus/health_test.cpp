#include "voxlist/bus/health.h"

#include <gtest/gtest.h>

#include <voxlist/health_t.hpp>

#include "voxlist/bus/wire.h"

namespace voxlist::bus {
namespace {

TEST(Health, IsDueOnceASecond) {
  Health health("mapper");
  EXPECT_TRUE(health.due(5'000'000));
  EXPECT_FALSE(health.due(5'999'999));
  EXPECT_TRUE(health.due(6'000'000));
  EXPECT_TRUE(health.due(3)) << "the clock was set back";
}

TEST(Health, TellsStateMessageAndCounters) {
  Health health("mapper");
  health.set_state(Health::State::kWarning, "no clouds");
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
