#include "voxlist/service/drop_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voxlist::service {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(DropReport, TellsTheFirstAtOnce) {
  DropReport report;
  EXPECT_THAT(report.due({{"CLOUD/truncated", 1}}, 500),
              ElementsAre("CLOUD/truncated: 1 message(s)"));
}

TEST(DropReport, TellsTheRestOnceASecondWithTheCount) {
  DropReport report;
  report.due({{"CLOUD/truncated", 1}}, 0);
  EXPECT_THAT(report.due({{"CLOUD/truncated", 40}}, 999'999), IsEmpty());
  EXPECT_THAT(report.due({{"CLOUD/truncated", 41}}, 1'000'000),
              ElementsAre("CLOUD/truncated: 40 more message(s), 41 in all"));
  EXPECT_THAT(report.due({{"CLOUD/truncated", 42}}, 1'999'999), IsEmpty());
}

TEST(DropReport, IsSilentWhenNothingNewWentWrong) {
  DropReport report;
  report.due({{"CLOUD/truncated", 1}}, 0);
  EXPECT_THAT(report.due({{"CLOUD/truncated", 1}}, 5'000'000), IsEmpty());
}

TEST(DropReport, TellsOfEachReasonByItself) {
  DropReport report;
  report.due({{"CLOUD/truncated", 1}}, 0);
  EXPECT_THAT(report.due({{"CLOUD/truncated", 2}, {"POSE/unsent_refused", 3}}, 10),
              ElementsAre("POSE/unsent_refused: 3 message(s)"));
}

}  // namespace
}  // namespace voxlist::service
