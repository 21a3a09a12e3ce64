#include "voxlist/service/inputs/time_gate.h"

#include <gtest/gtest.h>

#include <limits>

namespace voxlist::service {
namespace {

using Verdict = TimeGate::Verdict;
constexpr std::int64_t kSecond_us = 1'000'000;
constexpr std::int64_t kNow_us = 1'700'000'000 * kSecond_us;

TEST(TimeGate, LetsTimesPassThatGoOn) {
  TimeGate gate;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(gate.judge(kNow_us + i * kSecond_us), Verdict::kFits);
}

TEST(TimeGate, BeginsAtZeroAsAFolderOfScansDoes) {
  TimeGate gate;
  EXPECT_EQ(gate.judge(0), Verdict::kFits);
  EXPECT_EQ(gate.judge(kSecond_us), Verdict::kFits);
}

TEST(TimeGate, KnowsTimesThatAreAllEqual) {
  TimeGate gate;
  EXPECT_EQ(gate.judge(0), Verdict::kFits);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(gate.judge(0), Verdict::kRepeated);
}

TEST(TimeGate, KnowsTimesThatRunBackwards) {
  TimeGate gate;
  EXPECT_EQ(gate.judge(kNow_us), Verdict::kFits);
  for (int i = 1; i < 10; ++i) EXPECT_EQ(gate.judge(kNow_us - i * kSecond_us), Verdict::kBackwards);
}

TEST(TimeGate, KnowsWhatIsNoMicroseconds) {
  TimeGate gate;
  for (const std::int64_t utime :
       {kNow_us * 1000, std::int64_t{-1}, std::numeric_limits<std::int64_t>::max(),
        std::numeric_limits<std::int64_t>::min()}) {
    EXPECT_EQ(gate.judge(utime), Verdict::kNotMicroseconds) << utime;
  }
  EXPECT_EQ(gate.judge(kNow_us), Verdict::kFits);
}

TEST(TimeGate, OneTimeFarAheadCostsItselfAlone) {
  TimeGate gate;
  gate.judge(kNow_us);
  EXPECT_EQ(gate.judge(kNow_us + 3600 * kSecond_us), Verdict::kAhead);
  EXPECT_EQ(gate.judge(kNow_us + kSecond_us), Verdict::kFits);
}

TEST(TimeGate, LeavesOutARecordingThatIsPlayedBesideTheRobot) {
  TimeGate gate;
  gate.judge(kNow_us);
  for (int i = 1; i < 20; ++i) {
    EXPECT_EQ(gate.judge(kNow_us - (1000 - i) * kSecond_us), Verdict::kBackwards);
    EXPECT_EQ(gate.judge(kNow_us + i * kSecond_us), Verdict::kFits);
  }
}

TEST(TimeGate, OneTimeAheadThatIsBelievedCostsTwoMore) {
  TimeGate gate;
  gate.judge(kNow_us);
  EXPECT_EQ(gate.judge(kNow_us + 50 * kSecond_us), Verdict::kFits);
  EXPECT_EQ(gate.judge(kNow_us + 1 * kSecond_us), Verdict::kBackwards);
  EXPECT_EQ(gate.judge(kNow_us + 2 * kSecond_us), Verdict::kBackwards);
  EXPECT_EQ(gate.judge(kNow_us + 3 * kSecond_us), Verdict::kFits);
  EXPECT_EQ(gate.judge(kNow_us + 4 * kSecond_us), Verdict::kFits);
}

TEST(TimeGate, AFirstTimeThatIsAbsurdDoesNotStay) {
  TimeGate gate;
  EXPECT_EQ(gate.judge(5 * kNow_us), Verdict::kFits);
  gate.judge(kNow_us);
  gate.judge(kNow_us + kSecond_us);
  EXPECT_EQ(gate.judge(kNow_us + 2 * kSecond_us), Verdict::kFits);
}

TEST(TimeGate, ForgedTimesAmongTrueOnesDoNotShutThemOut) {
  TimeGate gate;
  int passed = 0;
  for (int i = 0; i < 100; ++i) {
    passed += gate.judge(kNow_us + i * kSecond_us) == Verdict::kFits;
    gate.judge(kNow_us + (i % 2 == 0 ? 3 : 1000) * 3600 * kSecond_us + i);
  }
  EXPECT_GE(passed, 30);
}

TEST(TimeGate, LetsALittleDisorderPassWhereItIsUsual) {
  TimeGate gate(kSecond_us);
  EXPECT_EQ(gate.judge(kNow_us), Verdict::kFits);
  EXPECT_EQ(gate.judge(kNow_us - kSecond_us / 2), Verdict::kFits);
  EXPECT_EQ(gate.judge(kNow_us - 2 * kSecond_us), Verdict::kBackwards);
}

}  // namespace
}  // namespace voxlist::service
