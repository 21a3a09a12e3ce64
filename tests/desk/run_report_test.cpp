#include "services/voxlist/maps/run_report.h"

#include <gtest/gtest.h>

namespace voxlist::desk {
namespace {

TEST(RunReport, TellsWhatOdometryIsOffBy) {
  RunFigures figures;
  figures.odometry_bias = matching::OdometryBias{1.0 / 1.02 - 1.0, 0.0175, 0.004, 0.005};
  EXPECT_EQ(odometry_bias(figures),
            "odometry's ways are 2.0 +- 0.4 % too long, and turned by -1.0 +- 0.3 deg");
}

TEST(RunReport, SaysNothingOfOdometryThatScansHaveNotMeasured) {
  RunFigures figures;
  EXPECT_EQ(odometry_bias(figures), "");
  figures.odometry_bias = matching::OdometryBias{0.0, 0.0, 0.05, 0.05};
  EXPECT_EQ(odometry_bias(figures), "");
}

}  // namespace
}  // namespace voxlist::desk
