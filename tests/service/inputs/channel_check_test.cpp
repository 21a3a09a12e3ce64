#include "voxlist/service/inputs/channel_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <voxlist/health_t.hpp>

namespace voxlist::service {
namespace {

using ::testing::HasSubstr;
constexpr std::int64_t kSecond_us = 1'000'000;
constexpr std::int64_t kNow_us = 1'700'000'000 * kSecond_us;

// A channel at 10 Hz.
struct Channel {
  bool take(std::int64_t utime_us) {
    const bool fits = check.take(utime_us);
    wait(kSecond_us / 10);
    return fits;
  }
  void wait(std::int64_t us) { check.tick(now_us += us); }
  std::int64_t counted(const std::string& name) {
    const auto message = health.due(now_us += 2 * kSecond_us);
    for (const counter_t& counter : message->counters)
      if (counter.name == name) return counter.count;
    return 0;
  }

  bus::Health health{"localiser"};
  ChannelCheck check{health, {.channel = "CLOUD", .remedy = "is a scanner running?"}};
  std::int64_t now_us = kNow_us;
};

TEST(ChannelCheck, SaysNothingOfAGoodChannel) {
  Channel channel;
  for (int i = 0; i < 100; ++i) {
    channel.check.take_number(i);
    EXPECT_TRUE(channel.take(kNow_us + i * kSecond_us / 10));
    EXPECT_EQ(channel.health.message(), "");
  }
}

TEST(ChannelCheck, TellsWhatNeverCameAfterThreeSeconds) {
  Channel channel;
  channel.wait(0);
  channel.wait(3 * kSecond_us);
  EXPECT_EQ(channel.health.message(), "");
  channel.wait(1);
  EXPECT_EQ(channel.health.message(), "no CLOUD yet: is a scanner running?");
  EXPECT_EQ(channel.health.state(), bus::Health::State::kWarning);
  channel.take(kNow_us);
  EXPECT_EQ(channel.health.message(), "");
}

TEST(ChannelCheck, TellsSilenceAfterThreePeriodsUntilItEnds) {
  Channel channel;
  for (int i = 0; i < 20; ++i) channel.take(kNow_us + i);
  channel.wait(kSecond_us);
  EXPECT_EQ(channel.health.message(), "") << "1.0 s";
  channel.wait(kSecond_us);
  EXPECT_EQ(channel.health.message(), "no CLOUD for 2 s: is a scanner running?");
  channel.take(kNow_us + 30);
  EXPECT_EQ(channel.health.message(), "");
  channel.wait(2 * kSecond_us);
  EXPECT_THAT(channel.health.message(), HasSubstr("no CLOUD")) << "a pause must not hide the next";
}

TEST(ChannelCheck, ASlowChannelIsNotSilent) {
  Channel channel;
  for (int i = 0; i < 5; ++i) {
    channel.check.take(kNow_us + i);
    for (int s = 0; s < 2; ++s) channel.wait(kSecond_us);
    EXPECT_EQ(channel.health.message(), "");
  }
  channel.wait(4 * kSecond_us);
  EXPECT_EQ(channel.health.message(), "");
  channel.wait(2 * kSecond_us);
  EXPECT_THAT(channel.health.message(), HasSubstr("no CLOUD for"));
}

TEST(ChannelCheck, AnInputThatMayBeMissingIsNotMissed) {
  bus::Health health("localiser");
  ChannelCheck check(health, {.channel = "ODOMETRY", .remedy = "", .is_needed = false});
  check.tick(0);
  check.tick(100 * kSecond_us);
  EXPECT_EQ(health.message(), "");
}

TEST(ChannelCheck, RefusesAndCountsTimesThatDoNotFit) {
  Channel channel;
  EXPECT_TRUE(channel.take(0));
  EXPECT_FALSE(channel.take(0));
  EXPECT_THAT(channel.health.message(), HasSubstr("CLOUD has utime 0 in every message"));
  EXPECT_FALSE(channel.take(kNow_us * 1000));
  EXPECT_THAT(channel.health.message(), HasSubstr("is it in nanoseconds?"));
  EXPECT_FALSE(channel.take(kNow_us));
  EXPECT_THAT(channel.health.message(), HasSubstr("jumps ahead in utime"));
  EXPECT_EQ(channel.counted("CLOUD/utime_repeated"), 1);
  EXPECT_EQ(channel.counted("CLOUD/bad_utime"), 1);
  EXPECT_EQ(channel.counted("CLOUD/utime_far_ahead"), 1);
}

TEST(ChannelCheck, AConditionEndsFiveSecondsAfterItWasLastSeen) {
  Channel channel;
  channel.take(kNow_us);
  channel.take(kNow_us - 1);
  EXPECT_THAT(channel.health.message(), HasSubstr("goes back in utime"));
  for (int i = 1; i <= 48; ++i) channel.take(kNow_us + i);
  EXPECT_THAT(channel.health.message(), HasSubstr("goes back in utime"));
  for (int i = 49; i <= 51; ++i) channel.take(kNow_us + i);
  EXPECT_EQ(channel.health.message(), "");
}

TEST(ChannelCheck, CountsWhatGapsInTheNumbersTell) {
  Channel channel;
  for (const int seq : {5, 6, 9}) channel.check.take_number(seq);
  EXPECT_THAT(channel.health.message(), HasSubstr("CLOUD has gaps in seq: 2 of 4 lost"));
  for (const int seq : {10, 11, 15}) channel.check.take_number(seq);
  EXPECT_THAT(channel.health.message(), HasSubstr("CLOUD has gaps in seq: 5 of 10 lost"));
  EXPECT_EQ(channel.counted("CLOUD/lost_on_the_way"), 5);
  channel.check.take_number(18, 2);
  EXPECT_EQ(channel.counted("CLOUD/lost_on_the_way"), 5) << "16 and 17 came";
}

TEST(ChannelCheck, TellsHowManyWereLeftOutUntilNoneWereForFiveSeconds) {
  Channel channel;
  channel.check.leave_out(0);
  EXPECT_EQ(channel.health.message(), "");
  channel.check.leave_out(2);
  channel.check.leave_out(1);
  EXPECT_THAT(channel.health.message(), HasSubstr("3 of CLOUD left out for newer ones"));
  channel.take(kNow_us);
  for (int i = 1; i <= 51; ++i) channel.take(kNow_us + i);
  EXPECT_EQ(channel.health.message(), "");
  channel.check.leave_out(1);
  EXPECT_THAT(channel.health.message(), HasSubstr("1 of CLOUD left out"));
}

TEST(ChannelCheck, NumbersThatStayOrBeginAnewAreNoGaps) {
  Channel channel;
  for (const int seq : {0, 0, 0, 70'000, 0, 1, 2'147'483'647, -2'147'483'647 - 1, 0})
    channel.check.take_number(seq);
  EXPECT_EQ(channel.health.message(), "");
}

}  // namespace
}  // namespace voxlist::service
