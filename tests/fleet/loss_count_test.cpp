#include "voxlist/fleet/loss_count.h"

#include <gtest/gtest.h>

#include <limits>

namespace voxlist::fleet {
namespace {

constexpr std::int32_t kPid = 7;

void hear(LossCount& count, const std::string& channel, int times) {
  for (int i = 0; i < times; ++i) count.hear(channel);
}

TEST(LossCount, TellsWhatDidNotComeOnce) {
  LossCount count;
  EXPECT_EQ(count.told(kPid, {}), SentCounts{});
  hear(count, "POSE", 7);
  EXPECT_EQ(count.told(kPid, {{"POSE", 10}, {"HEALTH", 2}}),
            (SentCounts{{"POSE", 3}, {"HEALTH", 2}}));
  EXPECT_EQ(count.told(kPid, {{"POSE", 10}, {"HEALTH", 2}}), SentCounts{});
  hear(count, "POSE", 4);
  EXPECT_EQ(count.told(kPid, {{"POSE", 15}, {"HEALTH", 2}}), (SentCounts{{"POSE", 1}}));
}

TEST(LossCount, CountsFromTheFirstWordOn) {
  LossCount count;
  hear(count, "POSE", 3);
  EXPECT_EQ(count.told(kPid, {{"POSE", 1000}}), SentCounts{}) << "who comes late missed nothing";
  hear(count, "POSE", 9);
  EXPECT_EQ(count.told(kPid, {{"POSE", 1010}}), (SentCounts{{"POSE", 1}}));
}

TEST(LossCount, BeginsAnewWithARelayThatWasStartedAgain) {
  LossCount count;
  count.told(kPid, {});
  hear(count, "POSE", 100);
  EXPECT_EQ(count.told(kPid + 1, {{"POSE", 2}}), SentCounts{});
  hear(count, "POSE", 3);
  EXPECT_EQ(count.told(kPid + 1, {{"POSE", 6}}), (SentCounts{{"POSE", 1}}));
}

TEST(LossCount, IsNotMisledByAMessageThatOvertakesTheWord) {
  LossCount count;
  count.told(kPid, {});
  hear(count, "POSE", 12);
  EXPECT_EQ(count.told(kPid, {{"POSE", 10}}), SentCounts{});
  EXPECT_EQ(count.told(kPid, {{"POSE", 12}}), SentCounts{});
  EXPECT_EQ(count.told(kPid, {{"POSE", 13}}), (SentCounts{{"POSE", 1}}));
}

TEST(LossCount, TakesAnyNumbers) {
  LossCount count;
  count.told(kPid, {{"POSE", std::numeric_limits<std::int64_t>::min()}});
  hear(count, "POSE", 1);
  const auto lost = count.told(kPid, {{"POSE", std::numeric_limits<std::int64_t>::max()}});
  EXPECT_GT(lost.at("POSE"), 0);
  for (int i = 0; i < 3000; ++i) count.hear("CHANNEL_" + std::to_string(i));
  SentCounts many;
  for (int i = 0; i < 3000; ++i) many["OTHER_" + std::to_string(i)] = 1;
  EXPECT_LE(count.told(kPid, many).size(), LossCount::kMostChannels);
}

}  // namespace
}  // namespace voxlist::fleet
