#include "voxlist/drawing/plot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/drawing/pixels.h"

namespace voxlist::drawing {
namespace {

constexpr io::Rgb kRed{255, 0, 0};

TEST(Plot, PutsRoundNumbersOnAxes) {
  const auto ticks = plot_ticks(-0.31, 1.07, 6);
  ASSERT_EQ(ticks.size(), 3U);
  EXPECT_NEAR(ticks[0], 0.0, 1e-12);
  EXPECT_NEAR(ticks[1], 0.5, 1e-12);
  EXPECT_TRUE(plot_ticks(1.0, 1.0, 5).empty());
  EXPECT_TRUE(plot_ticks(0.0, NAN, 5).empty());
}

TEST(Plot, HoldsItsLabels) {
  const auto ink = [](const PlotFrame& frame) {
    const test::Pixels pixels = test::pixels_of(draw_plot(frame, {{"a", kRed, {{0, 0}, {2, 5}}}}));
    return pixels.rgb.size() - pixels.count({255, 255, 255});
  };
  const std::size_t bare = ink({"", "", "", 400, 300, false});
  EXPECT_GT(ink({"title", "", "", 400, 300, false}), bare + 50);
  EXPECT_GT(ink({"", "time (s)", "", 400, 300, false}), bare + 50);
  EXPECT_GT(ink({"", "", "error (m)", 400, 300, false}), bare + 50);
}

TEST(Plot, DrawsLinesAndSurvivesHavingNone) {
  const Picture some = draw_plot({"t", "x", "y", 400, 300, true}, {{"a", kRed, {{0, 0}, {2, 5}}}});
  EXPECT_GT(test::pixels_of(some).count(kRed), 100U);
  const Picture none = draw_plot({"t", "x", "y", 400, 300, false}, {{"a", kRed, {}}});
  EXPECT_EQ(none.width(), 400);
  draw_plot({"t", "x", "y", 400, 300, false}, {{"a", kRed, {{NAN, 1}, {3, 3}}}});
}

}  // namespace
}  // namespace voxlist::drawing
