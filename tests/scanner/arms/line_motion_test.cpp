#include "voxlist/scanner/arms/line_motion.h"

#include <gtest/gtest.h>

namespace voxlist::scanner {
namespace {

constexpr std::int64_t kLine_us = 13'333;

// A watch on a mirror whose arms passed four times, between which 80 ms of lines did not change.
class StallWatchTest : public testing::Test {
 protected:
  StallWatchTest() {
    for (int passage = 0; passage < 4; ++passage) {
      see(0.0, 6);
      see(0.5, 30);
      watch_.turned();
    }
  }

  // Takes so many lines of which this share of the beams has changed.
  void see(double changed, int lines) {
    for (int i = 0; i < lines; ++i) watch_.add(changed, now_us_ += kLine_us);
  }

  StallWatch watch_;

 private:
  std::int64_t now_us_ = 0;
};

TEST_F(StallWatchTest, IsNotStalledWhereLinesAreStillAsUsual) {
  see(0.0, 8);
  EXPECT_FALSE(watch_.stalled());
}

TEST_F(StallWatchTest, IsStalledWhereNothingChangesAnyMore) {
  see(0.0, 23);
  EXPECT_TRUE(watch_.stalled());
}

TEST_F(StallWatchTest, IsStalledUnderARobotThatTurns) {
  see(0.1, 23);
  EXPECT_TRUE(watch_.stalled());
}

TEST_F(StallWatchTest, IsNotStalledWhereATurningMirrorChangesLittle) {
  see(0.2, 23);
  EXPECT_FALSE(watch_.stalled());
}

}  // namespace
}  // namespace voxlist::scanner
