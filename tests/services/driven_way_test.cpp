#include "services/grid_export/driven_way.h"

#include <gtest/gtest.h>

#include <cmath>

#include "voxlist/simulation/random.h"

namespace voxlist::services {
namespace {

constexpr std::int64_t kMap = 7;

class DrivenWayTest : public testing::Test {
 protected:
  DrivenWayTest() { way_.follow({kMap, 0, 0}); }

  bool drive_to(double x_m, double y_m) {
    pose_t pose{};
    pose.utime = ++utime_us_;
    pose.pos[0] = x_m;
    pose.pos[1] = y_m;
    way_.take(pose);
    uncertain_pose_t word{};
    word.utime = utime_us_;
    word.map_id = kMap;
    return way_.take(word);
  }

  // A lap of 31 m, a centimetre beside the last one or so.
  void drive_lap(simulation::Random& random) {
    for (int i = 0; i < 310; ++i) {
      const double angle = i * 2.0 * M_PI / 310.0;
      const double radius_m = 5.0 + 0.01 * random.normal();
      drive_to(radius_m * std::cos(angle), radius_m * std::sin(angle));
    }
  }

  std::size_t kept() const {
    std::size_t count = 0;
    for (const auto& part : way_.poses()) count += part.size();
    return count;
  }

  DrivenWay way_;
  std::int64_t utime_us_ = 0;
};

TEST_F(DrivenWayTest, KeepsWhatIsDrivenAgainOnce) {
  simulation::Random random(1);
  drive_lap(random);
  EXPECT_GT(kept(), 250U);
  for (int lap = 0; lap < 100; ++lap) drive_lap(random);
  const std::size_t after_100 = kept();
  for (int lap = 0; lap < 100; ++lap) drive_lap(random);
  EXPECT_LT(kept(), after_100 + after_100 / 10);
  EXPECT_TRUE(drive_to(5.0, 1.2));
}

TEST_F(DrivenWayTest, JoinsNoPlacesBetweenWhichTheRobotWasElsewhere) {
  EXPECT_TRUE(drive_to(0.0, 0.0));
  EXPECT_TRUE(drive_to(0.5, 0.0));
  EXPECT_FALSE(drive_to(0.0, 0.0));
  EXPECT_TRUE(drive_to(0.0, 0.5));
  ASSERT_EQ(way_.poses().size(), 2U);
  EXPECT_EQ(way_.poses()[0].back(), Eigen::Vector3d(0.5, 0.0, 0.0));
  EXPECT_EQ(way_.poses()[1].front(), Eigen::Vector3d(0.0, 0.0, 0.0));
  EXPECT_EQ(way_.poses()[1].back(), Eigen::Vector3d(0.0, 0.5, 0.0));
}

TEST_F(DrivenWayTest, TakesNoPositionThatIsNone) {
  EXPECT_FALSE(drive_to(NAN, 0.0));
  EXPECT_FALSE(drive_to(1e300, 0.0));
  EXPECT_TRUE(way_.poses().empty());
}

}  // namespace
}  // namespace voxlist::services
