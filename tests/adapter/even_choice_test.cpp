#include "voxlist/adapter/even_choice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace voxlist::adapter {
namespace {

std::vector<std::size_t> chosen(std::size_t rows, std::size_t at_most) {
  const EvenChoice choice(rows, at_most);
  std::vector<std::size_t> kept;
  for (std::size_t row = 0; row < rows; ++row)
    if (choice.keeps(row)) kept.push_back(row);
  return kept;
}

TEST(EvenChoice, KeepsAllOfWhatIsFewEnough) {
  EXPECT_EQ(chosen(30'000, 30'000).size(), 30'000u);
  EXPECT_EQ(chosen(1, 100).size(), 1u);
  EXPECT_TRUE(chosen(0, 100).empty());
}

TEST(EvenChoice, KeepsAboutAsManyAsAskedFor) {
  for (const std::size_t rows : {30'001u, 65'536u, 131'072u, 2'500'000u})
    EXPECT_NEAR(static_cast<double>(chosen(rows, 30'000).size()), 30'000.0, 10.0) << rows;
}

TEST(EvenChoice, LeavesNoGap) {
  const auto kept = chosen(131'072, 30'000);
  for (std::size_t i = 1; i < kept.size(); ++i) EXPECT_LE(kept[i] - kept[i - 1], 8u);
}

TEST(EvenChoice, TakesAsMuchOfEachRing) {
  for (const std::size_t rings : {16u, 32u, 64u, 128u}) {
    std::vector<int> of_ring(rings);
    for (const std::size_t row : chosen(131'072, 30'000)) ++of_ring[row % rings];
    const double even = 30'000.0 / static_cast<double>(rings);
    for (const int n : of_ring) EXPECT_NEAR(n, even, 0.03 * even + 3.0) << rings;
  }
}

}  // namespace
}  // namespace voxlist::adapter
