#include "voxlist/geometry/uncertain_pose.h"

#include <gtest/gtest.h>

#include <numbers>

namespace voxlist {
namespace {

Eigen::Matrix3d diagonal(double x, double y, double yaw) {
  return Eigen::Vector3d(x, y, yaw).asDiagonal();
}

TEST(UncertainPose, CarriesAHeadingsErrorIntoThePositionThatIsReachedByIt) {
  const UncertainPose a{{0.0, 0.0, std::numbers::pi / 2}, diagonal(0.0, 0.0, 1e-4)};
  const UncertainPose reached = a * UncertainPose{{3.0, 0.0, 0.0}, diagonal(0.04, 0.0, 0.0)};
  EXPECT_NEAR(reached.pose.y_m, 3.0, 1e-12);
  EXPECT_NEAR(reached.covariance(0, 0), 9e-4, 1e-12) << "across: 3 m at 0.01 rad";
  EXPECT_NEAR(reached.covariance(1, 1), 0.04, 1e-12) << "along: the step's own";
}

TEST(UncertainPose, TellsTheDirectionInWhichItIsLeastSure) {
  EXPECT_NEAR(worst_sigma_m(diagonal(0.04, 0.01, 9.0)), 0.2, 1e-12);
  Eigen::Matrix3d turned = diagonal(0.0, 0.0, 1.0);
  turned.topLeftCorner<2, 2>() << 0.0052, 0.0048, 0.0048, 0.0052;
  EXPECT_NEAR(worst_sigma_m(turned), 0.1, 1e-12);
}

TEST(UncertainPose, MeasuresDistancesInStandardDeviations) {
  const UncertainPose pose{{1.0, 2.0, 3.0}, diagonal(0.01, 0.04, 1.0)};
  EXPECT_NEAR(mahalanobis2({1.1, 2.4, 3.0 - 2.0 * std::numbers::pi}, pose), 1.0 + 4.0, 1e-9);
}

}  // namespace
}  // namespace voxlist
