#include "voxlist/voxels/counters/counter_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace voxlist {
namespace {

constexpr std::uint32_t kSeed = 20'260'515;

// One cell as OctoMap keeps it, and as the rule says in whole counts.
struct Cell {
  bool known = false;
  double log_odds = 0.0;
  int count = 0;

  void update(bool hit, const CounterRule& rule, double of_hit, double of_pass) {
    known = true;
    log_odds = std::clamp(log_odds + (hit ? of_hit : -of_pass), -2.0, 3.5);
    count = std::clamp(count + (hit ? rule.hit : -rule.pass), rule.lowest, rule.highest);
  }
};

double logit(double probability) { return std::log(probability / (1.0 - probability)); }

bool has(const BlockBits& bits, std::size_t cell) {
  return (bits[cell / 64] >> cell % 64 & 1) != 0;
}

void put(BlockBits& bits, std::size_t cell, bool set) {
  if (set) bits[cell / 64] |= std::uint64_t{1} << cell % 64;
}

// 512 cells with hits of another share each; most scans see most cells.
class Updates {
 public:
  Updates(double hit_probability, double pass_probability)
      : rule(CounterRule::of(hit_probability, pass_probability)),
        of_hit_(logit(hit_probability)),
        of_pass_(-logit(pass_probability)),
        update_(rule) {}

  void add() {
    BlockBits passed{}, hit{};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const bool is_hit = uniform_(random_) < static_cast<double>(i) / 511.0;
      const bool is_seen = uniform_(random_) < 0.8;
      put(hit, i, is_seen && is_hit);
      // A cell that is hit may be passed as well.
      put(passed, i, is_seen && (!is_hit || i % 2 == 0));
      if (is_seen) cells[i].update(is_hit, rule, of_hit_, of_pass_);
    }
    update_.count(CounterUpdate::Cells(passed), CounterUpdate::Cells(hit), block);
  }

  BlockBits occupied() const { return update_.occupied(block); }

  CounterRule rule;
  std::vector<Cell> cells = std::vector<Cell>(512);
  CounterBlock block;

 private:
  const double of_hit_, of_pass_;
  CounterUpdate update_;
  std::mt19937 random_{kSeed};
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

TEST(CounterBlock, CountsEachCellAsTheRuleSays) {
  SCOPED_TRACE(kSeed);
  for (const auto& [hit, pass] : std::vector<std::pair<double, double>>{
           {0.7, 0.4}, {0.6, 0.3}, {0.95, 0.4}, {0.9, 0.1}, {0.51, 0.49}, {0.99, 0.01}}) {
    Updates updates(hit, pass);
    for (int i = 0; i < 60; ++i) {
      updates.add();
      const BlockBits known = updates.block.known(), occupied = updates.occupied();
      for (std::size_t c = 0; c < 512; ++c) {
        const Cell& cell = updates.cells[c];
        ASSERT_EQ(has(known, c), cell.known) << hit << ' ' << pass << ' ' << c;
        ASSERT_EQ(has(occupied, c), cell.known && cell.count >= 0)
            << hit << ' ' << pass << ' ' << c;
        if (cell.known) {
          ASSERT_EQ(static_cast<int>(updates.block.value(c)) - 1 + updates.rule.lowest, cell.count);
        }
      }
    }
  }
}

TEST(CounterBlock, AgreesWithClampedLogOddsInAllButAFewUpdates) {
  SCOPED_TRACE(kSeed);
  Updates updates(0.7, 0.4);
  int differ = 0, all = 0;
  for (int i = 0; i < 400; ++i) {
    updates.add();
    const BlockBits occupied = updates.occupied();
    for (std::size_t c = 0; c < 512; ++c, ++all)
      differ += has(occupied, c) != (updates.cells[c].known && updates.cells[c].log_odds >= 0.0);
  }
  EXPECT_EQ(all, 204'800);
  EXPECT_LT(differ, all / 200);
}

TEST(CounterRule, IsOctomapsOwnByDefault) {
  const CounterRule rule = CounterRule::of(0.7, 0.4);
  EXPECT_EQ(rule.hit, 2);
  EXPECT_EQ(rule.pass, 1);
  EXPECT_EQ(rule.lowest, -5);
  EXPECT_EQ(rule.highest, 8);
  EXPECT_NEAR(rule.log_odds_of(1), 0.405, 0.001);
  EXPECT_EQ(rule.log_odds_of(rule.lowest), -2.0);
  EXPECT_LE(rule.log_odds_of(rule.highest), 3.5);
}

TEST(CounterRule, HasFifteenCountsAtMostWhateverTheProbabilities) {
  for (double hit = 0.51; hit < 0.995; hit += 0.02)
    for (double pass = 0.01; pass < 0.495; pass += 0.02) {
      const CounterRule rule = CounterRule::of(hit, pass);
      EXPECT_LT(rule.highest - rule.lowest, 15) << hit << ' ' << pass;
      EXPECT_LT(rule.lowest, 0);
      EXPECT_GE(rule.highest, 0);
      EXPECT_GE(rule.hit, 1);
      EXPECT_GE(rule.pass, 1);
    }
}

}  // namespace
}  // namespace voxlist
