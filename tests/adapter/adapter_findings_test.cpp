#include "voxlist/adapter/adapter_findings.h"

#include <gmock/gmock.h>

namespace voxlist::adapter {
namespace {

using testing::AllOf;
using testing::HasSubstr;

SensorReport with_points(std::int64_t kept, std::int64_t too_near, std::int64_t on_robot) {
  SensorReport report;
  report.points[static_cast<std::size_t>(PointFate::kPoint)] = kept;
  report.points[static_cast<std::size_t>(PointFate::kTooNear)] = too_near;
  report.points[static_cast<std::size_t>(PointFate::kRobot)] = on_robot;
  return report;
}

TEST(AdapterFindings, AreNoneOfAGoodMessage) {
  SensorReport report = with_points(1000, 500, 100);
  ++report[MessageFate::kUsed];
  EXPECT_TRUE(findings(report, "LASER_3D").empty());
  EXPECT_TRUE(findings(SensorReport{}, "LASER_3D").empty());
}

TEST(AdapterFindings, SayWhereAllPointsWent) {
  SensorReport report = with_points(0, 7, 3);
  ++report[MessageFate::kNoPoints];
  const auto found = findings(report, "LASER_3D");
  ASSERT_GE(found.size(), 1u);
  EXPECT_EQ(found[0].grade, Grade::kError);
  EXPECT_THAT(found[0].sentence,
              AllOf(HasSubstr("no point of LASER_3D"), HasSubstr("7 nearer than range_min_m"),
                    HasSubstr("3 on the robot")));
}

TEST(AdapterFindings, TellOfBoxesThatHoldNearlyAll) {
  EXPECT_TRUE(findings(with_points(100, 0, 900), "LASER_3D").empty());
  const auto found = findings(with_points(50, 0, 950), "LASER_3D");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].grade, Grade::kWarning);
  EXPECT_THAT(found[0].sentence, HasSubstr("robot_boxes_m hold 95 % of LASER_3D's points"));
}

TEST(AdapterFindings, TellOfTimesAndOfOdometry) {
  SensorReport report;
  report.time_complaint = "the points' times are 100 s apart";
  ++report[MessageFate::kBadTimes];
  ++report[MessageFate::kNoOdometry];
  const auto found = findings(report, "LASER_3D");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].sentence, "LASER_3D: the points' times are 100 s apart");
  EXPECT_EQ(found[0].grade, Grade::kError);
  EXPECT_THAT(found[1].sentence, HasSubstr("waits for ODOMETRY in vain"));
}

TEST(AdapterFindings, TellOfALaserThatIsFasterThanItMayBe) {
  SensorReport report;
  ++report[MessageFate::kSuperseded];
  const auto found = findings(report, "LASER_3D");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].grade, Grade::kNote);
  EXPECT_THAT(found[0].sentence, HasSubstr("LASER_3D comes faster than CLOUD may"));
}

}  // namespace
}  // namespace voxlist::adapter
