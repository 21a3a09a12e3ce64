#include "voxlist/matching/localisation/confidence.h"

#include <gtest/gtest.h>

#include <numeric>

namespace voxlist::matching {
namespace {

double of_single(double support, double rival) {
  return probabilities(std::vector{odds_of({support, support}, rival, {})}).front();
}

TEST(Confidence, GrowsWithSupportAndWithTheDistanceOfTheNextBestPlace) {
  EXPECT_GT(of_single(0.98, 0.6), 0.99);
  EXPECT_LT(of_single(0.75, 0.73), 0.2);
  EXPECT_GT(of_single(0.9, 0.7), of_single(0.8, 0.6));
  EXPECT_GT(of_single(0.9, 0.7), of_single(0.9, 0.85));
}

TEST(Confidence, TellsPlacesApartByNearRaysAndWhetherAnyIsRightByEvenOnes) {
  const Odds place = odds_of({0.9, 0.95}, 0.8, {}), nearer = odds_of({0.92, 0.95}, 0.8, {}),
             evener = odds_of({0.9, 0.97}, 0.8, {});
  EXPECT_GT(nearer.place, place.place);
  EXPECT_EQ(nearer.found, place.found);
  EXPECT_EQ(evener.place, place.place);
  EXPECT_GT(evener.found, place.found);
}

TEST(Confidence, IsSharedEvenlyByPlacesThatLookAlike) {
  const std::vector<Odds> alike(20, odds_of({0.99, 0.99}, 0.99, {}));
  for (const double p : probabilities(alike)) {
    EXPECT_NEAR(p, probabilities(alike).front(), 1e-12);
    EXPECT_LT(p, 0.05);
  }
}

TEST(Confidence, LeavesSomethingForNoneOfThem) {
  const auto p =
      probabilities(std::vector{odds_of({0.8, 0.8}, 0.7, {}), odds_of({0.7, 0.7}, 0.8, {})});
  EXPECT_GT(p[0], p[1]);
  EXPECT_LT(std::accumulate(p.begin(), p.end(), 0.0), 0.95);
  EXPECT_TRUE(probabilities({}).empty());
}

TEST(Confidence, AddsUpOverScansInProportionToTheirWeight) {
  Odds sum = odds_of({0.9, 0.9}, 0.8, {});
  sum += odds_of({0.9, 0.9}, 0.8, {0.5, 0.25});
  EXPECT_NEAR(sum.place, 1.5 * odds_of({0.9, 0.9}, 0.8, {}).place, 1e-9);
  EXPECT_NEAR(sum.found, 1.25 * odds_of({0.9, 0.9}, 0.8, {}).found, 1e-9);
}

TEST(Confidence, StaysFiniteForAnySupport) {
  const auto p =
      probabilities(std::vector{odds_of({1.0, 1.0}, -5.0, {}), odds_of({-5.0, -5.0}, 1.0, {})});
  EXPECT_GT(p[0], 0.99);
  EXPECT_GE(p[1], 0.0);
  EXPECT_LT(p[1], 1e-6);
}

}  // namespace
}  // namespace voxlist::matching
