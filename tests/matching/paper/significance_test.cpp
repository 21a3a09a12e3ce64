#include "voxlist/matching/paper/significance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace voxlist::matching {
namespace {

constexpr ChanceModel kTable[] = {{1000, 100, 50}, {50, 20, 10}, {10, 4, 3}};

TEST(Significance, MeanAndVarianceAreThoseOfTheHypergeometricDistribution) {
  EXPECT_DOUBLE_EQ(overlap_mean({1000, 100, 50}), 5.0);
  EXPECT_NEAR(overlap_variance({1000, 100, 50}), 4.279279, 5e-7);
  EXPECT_DOUBLE_EQ(overlap_mean({50, 20, 10}), 4.0);
  EXPECT_NEAR(overlap_variance({50, 20, 10}), 1.959184, 5e-7);
  EXPECT_DOUBLE_EQ(overlap_mean({10, 4, 3}), 1.2);
  EXPECT_DOUBLE_EQ(overlap_variance({10, 4, 3}), 0.56);
  EXPECT_NEAR(overlap_mean({296875, 15000, 1500}), 75.79, 0.005);
  EXPECT_NEAR(std::sqrt(overlap_variance({296875, 15000, 1500})), 8.46, 0.005);
  EXPECT_NEAR(overlap_mean({296875, 30000, 2500}), 252.63, 0.005);
  EXPECT_NEAR(std::sqrt(overlap_variance({296875, 30000, 2500})), 15.01, 0.005);
  EXPECT_DOUBLE_EQ(occupied_share({1000, 100, 50}), 0.1);
}

TEST(Significance, TailHasItsKnownValues) {
  EXPECT_NEAR(std::pow(10.0, log10_overlap_tail({1000, 100, 50}, 10)), 2.144032938e-02, 5e-12);
  EXPECT_NEAR(std::pow(10.0, log10_overlap_tail({50, 20, 10}, 7)), 3.648184948e-02, 5e-12);
  EXPECT_NEAR(std::pow(10.0, log10_overlap_tail({10, 4, 3}, 2)), 1.0 / 3.0, 1e-14);
  EXPECT_NEAR(log10_overlap_tail({296875, 15000, 1500}, 379), -151.3, 0.05);
  EXPECT_NEAR(log10_overlap_tail({296875, 30000, 2500}, 379), -14.8, 0.05);
}

TEST(Significance, ProbabilitiesSumToOne) {
  for (const ChanceModel& m : {kTable[0], kTable[1], kTable[2], ChanceModel{296875, 15000, 1500},
                               ChanceModel{20, 15, 12}}) {
    double sum = 0.0;
    for (std::int64_t o = 0; o <= m.scan_voxels; ++o)
      sum += std::pow(10.0, log10_overlap_probability(m, o));
    EXPECT_NEAR(sum, 1.0, 1e-10) << m.volume_voxels;
  }
}

TEST(Significance, ProbabilitiesHaveTheStatedMeanAndVariance) {
  for (const ChanceModel& m : kTable) {
    double mean = 0.0, square = 0.0;
    for (std::int64_t o = 0; o <= m.scan_voxels; ++o) {
      const double p = std::pow(10.0, log10_overlap_probability(m, o)),
                   value = static_cast<double>(o);
      mean += p * value;
      square += p * value * value;
    }
    EXPECT_NEAR(mean, overlap_mean(m), 1e-10);
    EXPECT_NEAR(square - mean * mean, overlap_variance(m), 1e-9);
  }
}

TEST(Significance, TailIsTheSumOfProbabilitiesOnBothSidesOfTheMean) {
  for (const ChanceModel& m : kTable) {
    double tail = 0.0;
    for (std::int64_t o = m.scan_voxels; o >= 0; --o) {
      tail += std::pow(10.0, log10_overlap_probability(m, o));
      if (tail > 0.0) {
        EXPECT_NEAR(std::pow(10.0, log10_overlap_tail(m, o)) / tail, 1.0, 1e-9) << o;
      }
    }
  }
}

TEST(Significance, EveryScanOverlapsAtLeastAsMuchAsItMust) {
  EXPECT_EQ(log10_overlap_tail({1000, 100, 50}, 0), 0.0);
  EXPECT_EQ(log10_overlap_tail({1000, 100, 50}, -3), 0.0);
  // 12 voxels into a volume with 5 free ones: 7 hit at least.
  EXPECT_EQ(log10_overlap_tail({20, 15, 12}, 7), 0.0);
  EXPECT_LT(log10_overlap_tail({20, 15, 12}, 8), 0.0);
  EXPECT_EQ(log10_overlap_tail({20, 20, 12}, 12), 0.0);
}

TEST(Significance, NoScanOverlapsMoreThanItsOrTheMapsVoxels) {
  EXPECT_EQ(log10_overlap_tail({1000, 100, 50}, 51), -INFINITY);
  EXPECT_EQ(log10_overlap_tail({1000, 40, 50}, 41), -INFINITY);
  EXPECT_GT(log10_overlap_tail({1000, 100, 50}, 50), -INFINITY);
  EXPECT_EQ(log10_overlap_tail({1000, 0, 50}, 1), -INFINITY);
  EXPECT_EQ(log10_overlap_probability({1000, 100, 50}, 51), -INFINITY);
  EXPECT_EQ(log10_overlap_probability({1000, 100, 50}, -1), -INFINITY);
}

// With V >> N, n the overlap is a Poisson count: any digits that V cost would show.
TEST(Significance, KeepsItsDigitsInHugeVolumes) {
  const ChanceModel m{4'000'000'000'000'000, 2'000'000'000, 1'000'000};  // mean 0.5
  EXPECT_NEAR(std::pow(10.0, log10_overlap_probability(m, 0)), std::exp(-0.5), 1e-6);
  EXPECT_NEAR(std::pow(10.0, log10_overlap_tail(m, 3)), 1.0 - std::exp(-0.5) * (1.0 + 0.5 + 0.125),
              1e-6);
}

TEST(Significance, IsNormalNearTheMeanOfLargeCounts) {
  const ChanceModel m{1'000'000'000, 100'000'000, 1'000'000};
  const double o = overlap_mean(m) + 3.0 * std::sqrt(overlap_variance(m));
  const double normal = 0.5 * std::erfc(3.0 / std::sqrt(2.0));
  EXPECT_NEAR(std::pow(10.0, log10_overlap_tail(m, std::llround(o))) / normal, 1.0, 0.05);
}

TEST(Significance, FallsWithTheOverlap) {
  double last = 0.0;
  for (std::int64_t o = 1; o <= 1500; o += 13) {
    const double tail = log10_overlap_tail({296875, 15000, 1500}, o);
    EXPECT_LE(tail, last) << o;
    last = tail;
  }
  EXPECT_LT(last, -1000.0);
}

TEST(Significance, BestOfManyPosesIsLessSignificantButNeverAboveOne) {
  EXPECT_NEAR(log10_best_of(-14.8, 1e6), -8.8, 1e-12);
  EXPECT_EQ(log10_best_of(-2.0, 1e3), 0.0);
  EXPECT_EQ(log10_best_of(-INFINITY, 1e3), -INFINITY);
}

TEST(Significance, RequiredZGrowsWithThePosesThatWereTried) {
  EXPECT_NEAR(required_z(0.01, 1e3), 4.26, 0.006);
  EXPECT_NEAR(required_z(0.01, 1e4), 4.75, 0.006);
  EXPECT_NEAR(required_z(0.01, 1e5), 5.20, 0.006);
  EXPECT_NEAR(required_z(0.01, 1e6), 5.61, 0.006);
  EXPECT_NEAR(required_z(0.5, 1.0), 0.0, 1e-9);
}

TEST(Significance, RefusesCountsThatDoNotFitTheVolume) {
  EXPECT_THROW(overlap_mean({0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(overlap_variance({1, 5, 1}), std::invalid_argument);
  EXPECT_THROW(log10_overlap_tail({10, 11, 3}, 1), std::invalid_argument);
  EXPECT_THROW(log10_overlap_tail({10, 4, 11}, 1), std::invalid_argument);
  EXPECT_THROW(required_z(0.0, 10.0), std::invalid_argument);
  EXPECT_THROW(required_z(0.01, 0.5), std::invalid_argument);
}

}  // namespace
}  // namespace voxlist::matching
