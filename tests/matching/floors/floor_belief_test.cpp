#include "voxlist/matching/floors/floor_belief.h"

#include <gtest/gtest.h>

#include <cmath>

namespace voxlist::matching {
namespace {

constexpr std::int64_t kSecond_us = 1'000'000;

FloorView view(double x_m, double z_m, double support) {
  return {Pose3(Eigen::Translation3d(x_m, 0.0, z_m)), support};
}

// Scans of a robot at x on the lower of two floors: how they fit it, and the upper one.
class TwoFloors {
 public:
  double upper(double seconds, double x_m, double here, double above, bool is_boxed = false) {
    belief_.weigh(std::llround(seconds * kSecond_us), is_boxed, view(x_m, 0.0, here),
                  {view(x_m, 3.0, above)});
    return belief_.probabilities()[1];
  }

 private:
  FloorBelief belief_;
};

TEST(FloorBelief, ADriveStaysSureWhereFloorsAreTheSame) {
  TwoFloors floors;
  for (int i = 0; i < 500; ++i) EXPECT_LT(floors.upper(0.1 * i, 0.05 * i, 0.95, 0.95), 0.002) << i;
}

TEST(FloorBelief, TheFirstScanOfAnotherFloorMakesItDoubtfulAndTheNextOnesSure) {
  TwoFloors floors;
  EXPECT_LT(floors.upper(0.0, 0.0, 0.99, 0.90), 0.001);
  EXPECT_GT(floors.upper(0.1, 0.1, 0.90, 0.99), 0.05);
  double upper = 0.0;
  for (int i = 2; i < 20; ++i) upper = floors.upper(0.1 * i, 0.1 * i, 0.90, 0.99);
  EXPECT_GT(upper, 0.996);
}

TEST(FloorBelief, ScansOfARobotThatStandsSayTheSameAgain) {
  TwoFloors floors;
  floors.upper(0.0, 0.0, 0.99, 0.90);
  const double first = floors.upper(0.1, 0.0, 0.93, 0.97);
  for (int i = 2; i < 50; ++i)
    EXPECT_NEAR(floors.upper(0.1 * i, 0.0, 0.93, 0.97), first, 1e-9) << i;
}

TEST(FloorBelief, AfterARideInABoxEitherFloorIsAsLikely) {
  TwoFloors floors;
  floors.upper(0.0, 0.0, 0.95, 0.95);
  for (int i = 1; i <= 80; ++i) floors.upper(0.1 * i, 0.0, 0.99, 0.2, true);
  EXPECT_NEAR(floors.upper(8.1, 0.1, 0.95, 0.95), 0.5, 0.01);
  EXPECT_GT(floors.upper(8.2, 0.2, 0.95, 0.95), 0.4);
}

TEST(FloorBelief, AScanThatTellsFloorsApartEndsTheDoubtOfARide) {
  TwoFloors floors;
  floors.upper(0.0, 0.0, 0.95, 0.95);
  EXPECT_LT(floors.upper(8.0, 0.1, 0.99, 0.85), 0.001);
}

TEST(FloorBelief, ARobotThatDroveMeanwhileWasInNoLift) {
  TwoFloors floors;
  floors.upper(0.0, 0.0, 0.95, 0.95);
  EXPECT_LT(floors.upper(8.0, 4.0, 0.95, 0.95), 0.002);
}

}  // namespace
}  // namespace voxlist::matching
