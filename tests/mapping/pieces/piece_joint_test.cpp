#include "voxlist/mapping/pieces/piece_joint.h"

#include <gtest/gtest.h>

#include "voxlist/mapping/pieces/piece.h"

namespace voxlist::mapping {
namespace {

constexpr double kLikely = 0.996;
const Pose2 kThereHere{3.0, 1.0, 0.5}, kFirst{1.0, 2.0, 0.1}, kSecond{4.0, 2.0, 0.1};

TEST(PieceJoint, IsSureOfTwoScansThatAgree) {
  PieceJoint joint;
  EXPECT_FALSE(joint.add(nullptr, kThereHere * kFirst, kFirst, kLikely));
  EXPECT_TRUE(joint.add(nullptr, kThereHere * kSecond, kSecond, kLikely));
}

TEST(PieceJoint, IsNotSureOfTwoScansThatDisagree) {
  PieceJoint joint;
  const Pose2 elsewhere{3.5, 1.0, 0.5}, turned{3.0, 1.0, 0.6};
  EXPECT_FALSE(joint.add(nullptr, kThereHere * kFirst, kFirst, kLikely));
  EXPECT_FALSE(joint.add(nullptr, elsewhere * kSecond, kSecond, kLikely));
  EXPECT_FALSE(joint.add(nullptr, turned * kSecond, kSecond, kLikely));
}

TEST(PieceJoint, IsSureOfOneScanThatNoWrongOneComesNear) {
  PieceJoint joint;
  EXPECT_TRUE(joint.add(nullptr, kThereHere * kFirst, kFirst, 0.99999));
}

TEST(PieceJoint, TakesNoScanOfAnotherPieceForOneThatAgrees) {
  const Piece a({}, MapBuilder(), Piece::Keep()), b({}, MapBuilder(), Piece::Keep());
  PieceJoint joint;
  EXPECT_FALSE(joint.add(&a, kThereHere * kFirst, kFirst, kLikely));
  EXPECT_FALSE(joint.add(&b, kThereHere * kSecond, kSecond, 0.9));
  joint.forget(&b);
  EXPECT_TRUE(joint.add(&a, kThereHere * kSecond, kSecond, 0.9));
  joint.forget(&a);
  EXPECT_FALSE(joint.add(&a, kThereHere * kSecond, kSecond, kLikely));
}

}  // namespace
}  // namespace voxlist::mapping
