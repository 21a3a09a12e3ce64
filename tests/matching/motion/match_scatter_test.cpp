#include "voxlist/matching/motion/match_scatter.h"

#include <gtest/gtest.h>

namespace voxlist::matching {
namespace {

UncertainPose at(double x_m, const Eigen::Vector3d& sigmas) {
  return {{x_m, 0.0, 0.0}, sigmas.cwiseAbs2().asDiagonal()};
}

// It was made with a looser prior: along x it is vaguer than the prediction.
TEST(MatchScatter, APoseIsNotPastAMatchThatIsFarFromWhereItShouldBe) {
  TrackedPose moved(at(1.0, {0.008, 0.007, 0.013}));
  MatchScatter().correct(moved, at(0.85, {0.012, 0.003, 0.005}));
  EXPECT_NEAR(moved.pose().pose.x_m, 0.85, 0.01);
}

TEST(MatchScatter, AVagueMatchThatIsNearMovesThePoseALittle) {
  TrackedPose moved(at(1.0, {0.02, 0.02, 0.02}));
  MatchScatter().correct(moved, at(1.01, {0.014, 0.014, 0.014}));
  EXPECT_GT(moved.pose().pose.x_m, 1.005);
  EXPECT_LT(moved.pose().pose.x_m, 1.0101);
}

}  // namespace
}  // namespace voxlist::matching
