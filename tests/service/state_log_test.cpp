#include "voxlist/service/state_log.h"

#include <gtest/gtest.h>

namespace voxlist::service {
namespace {

using State = bus::Health::State;
constexpr std::int64_t kSecond_us = 1'000'000;

TEST(StateLog, IsSilentWhileAllIsWellFromTheStart) {
  StateLog log;
  EXPECT_FALSE(log.due(State::kOk, "", 0));
}

TEST(StateLog, TellsEachChangeOnceAndItsEnd) {
  StateLog log;
  auto line = log.due(State::kError, "the disk is full", 0);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->state, State::kError);
  EXPECT_EQ(line->text, "the disk is full");
  EXPECT_FALSE(log.due(State::kError, "the disk is full", 100 * kSecond_us));
  line = log.due(State::kOk, "", 101 * kSecond_us);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->state, State::kOk);
  EXPECT_EQ(line->text, "all is well");
}

TEST(StateLog, OtherWordsAreNewsOtherNumbersAreNot) {
  StateLog log;
  EXPECT_TRUE(log.due(State::kWarning, "no clouds for 1.5 s", 0));
  EXPECT_FALSE(log.due(State::kWarning, "no clouds for 11 s", 1));
  EXPECT_TRUE(log.due(State::kWarning, "no odometry for 11 s", 2));
}

TEST(StateLog, TellsOneLineASecondOfAStateThatFlickers) {
  StateLog log;
  int lines = 0;
  for (int i = 0; i < 1000; ++i)
    lines += log.due(i % 2 == 0 ? State::kWarning : State::kOk, "", i * 20'000).has_value();
  EXPECT_GE(lines, 10 + 18);
  EXPECT_LE(lines, 10 + 20);
}

TEST(StateLog, InTheEndTellsHowItIs) {
  StateLog log;
  for (int i = 0; i < 100; ++i) log.due(i % 2 == 0 ? State::kWarning : State::kOk, "", 0);
  EXPECT_FALSE(log.due(State::kError, "the disk is full", 1));
  EXPECT_TRUE(log.due(State::kError, "the disk is full", kSecond_us + 1));
}

}  // namespace
}  // namespace voxlist::service
