#include "voxlist/scanner/mirror/edge_pace.h"

#include <gtest/gtest.h>

#include <random>

namespace voxlist::scanner {
namespace {

// Edges of 5 ms, or of `period_us`, through a stream that jitters, loses, doubles and adds some.
struct Edges {
  double period_us = 5000.0, jitter_us = 200.0, lost = 0.0, doubled = 0.0, strange = 0.0;
  double time_us = 0.0;
  std::mt19937 random{3};

  // Feeds edges until a change is told: after how many; -1 when none is.
  int feed(EdgePace& pace, int edges, double known_period_us) {
    std::normal_distribution<double> jitter(0.0, jitter_us);
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    for (int i = 0; i < edges; ++i) {
      time_us += period_us;
      if (chance(random) < lost) continue;
      for (int times = chance(random) < doubled ? 2 : 1; times > 0; --times)
        if (pace.changed(time_us + jitter(random), known_period_us)) return i + 1;
      if (chance(random) < strange && pace.changed(time_us + 0.5 * period_us, known_period_us))
        return i + 1;
    }
    return -1;
  }
};

TEST(EdgePace, TellsAnotherSpeedWithinThirtyEdges) {
  for (const double factor : {0.5, 0.67, 0.75, 0.9, 0.94, 0.95, 1.05, 1.06, 1.1, 1.33, 1.5}) {
    EdgePace pace;
    Edges edges;
    ASSERT_EQ(edges.feed(pace, 1000, 5000.0), -1);
    edges.period_us = factor * 5000.0;
    const int after = edges.feed(pace, 200, 5000.0);
    EXPECT_GT(after, 0) << factor;
    EXPECT_LE(after, 30) << factor;
  }
}

TEST(EdgePace, TakesAPoorStreamForNoOtherSpeed) {
  for (const double period_us : {2500.0, 5000.0, 24'000.0}) {
    EdgePace pace;
    Edges edges{.period_us = period_us, .jitter_us = 0.06 * period_us, .lost = 0.3, .doubled = 0.1};
    edges.strange = 0.02;
    EXPECT_EQ(edges.feed(pace, 1'000'000, period_us), -1) << period_us;
  }
}

TEST(EdgePace, TakesAHoleForNoOtherSpeed) {
  EdgePace pace;
  Edges edges;
  for (int hole = 0; hole < 100; ++hole) {
    ASSERT_EQ(edges.feed(pace, 100, 5000.0), -1);
    edges.time_us += 137 * 5000.0;
  }
}

}  // namespace
}  // namespace voxlist::scanner
