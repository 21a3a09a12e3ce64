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
  figures.odometry_bias = matching::OdometryBias{0.0, 0.0, 0.02, 0.03};
  EXPECT_EQ(odometry_bias(figures), "");
}

TEST(RunReport, TellsWhatLoopsMovedAndWhichWereNotBelieved) {
  RunFigures figures;
  EXPECT_EQ(closed_loops(figures) + refused_loops(figures), "");
  figures.loops = 5;
  figures.loops_moved_m = 2.466;
  EXPECT_EQ(closed_loops(figures),
            "the drive came back: 5 looks at ground of long before agree, and moved it by up to "
            "2.47 m");
  figures.loops_refused = 4;
  EXPECT_NE(refused_loops(figures).find("4 looks agree"), std::string::npos);
}

}  // namespace
}  // namespace voxlist::desk
