#include "voxlist/matching/localisation/confidence.h"

#include <gtest/gtest.h>

#include <numeric>

namespace voxlist::matching {
namespace {

double of_single(double support, double rival) {
  return probabilities(std::vector{log_odds_of({support, support}, rival, {})}).front();
}

TEST(Confidence, GrowsWithSupportAndWithTheDistanceOfTheSecondBestMode) {
  EXPECT_GT(of_single(0.98, 0.6), 0.99);
  EXPECT_LT(of_single(0.75, 0.73), 0.2);
  EXPECT_GT(of_single(0.9, 0.7), of_single(0.8, 0.6));
  EXPECT_GT(of_single(0.9, 0.7), of_single(0.9, 0.85));
}

TEST(Confidence, TellsPosesApartByNearRaysAndWhetherAnyIsRightByEvenOnes) {
  const LogOdds mode = log_odds_of({0.9, 0.95}, 0.8, {}),
                nearer = log_odds_of({0.92, 0.95}, 0.8, {}),
                evener = log_odds_of({0.9, 0.97}, 0.8, {});
  EXPECT_GT(nearer.among, mode.among);
  EXPECT_EQ(nearer.at_all, mode.at_all);
  EXPECT_EQ(evener.among, mode.among);
  EXPECT_GT(evener.at_all, mode.at_all);
}

TEST(Confidence, IsSharedEvenlyByPosesThatLookAlike) {
  const std::vector<LogOdds> alike(20, log_odds_of({0.99, 0.99}, 0.99, {}));
  for (const double p : probabilities(alike)) {
    EXPECT_NEAR(p, probabilities(alike).front(), 1e-12);
    EXPECT_LT(p, 0.05);
  }
}

TEST(Confidence, LeavesSomethingForNoneOfThem) {
  const auto p = probabilities(
      std::vector{log_odds_of({0.8, 0.8}, 0.7, {}), log_odds_of({0.7, 0.7}, 0.8, {})});
  EXPECT_GT(p[0], p[1]);
  EXPECT_LT(std::accumulate(p.begin(), p.end(), 0.0), 0.95);
  EXPECT_TRUE(probabilities({}).empty());
}

TEST(Confidence, AddsUpOverScansInProportionToTheirWeight) {
  LogOdds sum = log_odds_of({0.9, 0.9}, 0.8, {});
  sum += log_odds_of({0.9, 0.9}, 0.8, {0.5, 0.25});
  EXPECT_NEAR(sum.among, 1.5 * log_odds_of({0.9, 0.9}, 0.8, {}).among, 1e-9);
  EXPECT_NEAR(sum.at_all, 1.25 * log_odds_of({0.9, 0.9}, 0.8, {}).at_all, 1e-9);
}

TEST(Confidence, StaysFiniteForAnySupport) {
  const auto p = probabilities(
      std::vector{log_odds_of({1.0, 1.0}, -5.0, {}), log_odds_of({-5.0, -5.0}, 1.0, {})});
  EXPECT_GT(p[0], 0.99);
  EXPECT_GE(p[1], 0.0);
  EXPECT_LT(p[1], 1e-6);
}

}  // namespace
}  // namespace voxlist::matching
