#include "voxlist/service/resource_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <voxlist/health_t.hpp>

namespace voxlist::service {
namespace {

using ::testing::StartsWith;

TEST(ResourceReport, TellsWhatAServiceHolds) {
  bus::Health health("mapper");
  ResourceReport report;
  report.take({.queued_bytes = 2'500'000}, 21'000'000, 0, health);
  const health_t message = health.last(0);
  ASSERT_EQ(message.n_gauges, 2);
  EXPECT_EQ(message.gauges[0].name, "memory_MB");
  EXPECT_EQ(message.gauges[0].value, 21.0);
  EXPECT_EQ(message.gauges[1].name, "send_queue_MB");
  EXPECT_EQ(message.gauges[1].value, 2.5);
  EXPECT_EQ(health.message(), "");
}

TEST(ResourceReport, IsDueOnceASecond) {
  bus::Health health("mapper");
  ResourceReport report;
  EXPECT_TRUE(report.is_due(5));
  report.take({}, 0, 5, health);
  EXPECT_FALSE(report.is_due(1'000'004));
  EXPECT_TRUE(report.is_due(1'000'005));
}

TEST(ResourceReport, TellsALossUntilThereWasNoneForFiveSeconds) {
  bus::Health health("localiser");
  ResourceReport report;
  report.take({.dropped_packets = 3}, 0, 1'000'000, health);
  report.take({.dropped_packets = 7}, 0, 2'000'000, health);
  EXPECT_THAT(health.message(), StartsWith("7 packets found no room here"));
  report.take({.dropped_packets = 7}, 0, 6'999'999, health);
  EXPECT_EQ(health.state(), bus::Health::State::kWarning);
  report.take({.dropped_packets = 7}, 0, 7'000'000, health);
  EXPECT_EQ(health.message(), "");
  report.take({.failed_messages = 2, .superseded_messages = 4, .dropped_packets = 8}, 0, 8'000'000,
              health);
  EXPECT_THAT(health.message(), StartsWith("4 messages were left for newer ones"));
  EXPECT_THAT(health.message(), ::testing::HasSubstr("; 1 packets found no room"));
  EXPECT_THAT(health.message(), ::testing::HasSubstr("2 large messages were refused"));
  EXPECT_EQ(health.last(0).counters[0].count, 4) << "messages_left_for_newer";
  EXPECT_EQ(health.last(0).counters[1].count, 2) << "messages_not_sent";
  EXPECT_EQ(health.last(0).counters.back().count, 8) << "packets_without_room";
}

}  // namespace
}  // namespace voxlist::service
