// What is claimed of a prediction that is too vague for a window.
#include "voxlist/matching/localisation/reach_match.h"

#include <gtest/gtest.h>

#include "tests/matching/synthetic_room.h"

namespace voxlist::matching {
namespace {

MatchMode place(double x_m, double support) {
  MatchMode mode;
  mode.pose = {x_m, 0.0, 0.0};
  mode.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  mode.evidence.points = 500;
  mode.evidence.hits = static_cast<int>(500.0 * support);
  mode.evidence.misses = 500 - mode.evidence.hits;
  mode.support = support;
  mode.overlap_ratio = 0.9;
  return mode;
}

// Finds what it is told to.
class Told : public Matcher {
 public:
  Match match(const PreparedScan&, const std::optional<PoseWindow>&) override { return found(); }
  Match track(const PreparedScan&, const std::optional<PoseWindow>& window,
              const UncertainPose&) override {
    Match match = found();
    if (!window) match.modes.insert(match.modes.end(), elsewhere.begin(), elsewhere.end());
    return match;
  }
  Match track_rivals(const PreparedScan&, const UncertainPose&) override {
    Match match = found();
    match.modes.insert(match.modes.end(), rivals.begin(), rivals.end());
    return match;
  }
  Eigen::Matrix3d covariance_without_lines(const PreparedScan&, const MatchMode& mode,
                                           const UncertainPose&) override {
    return mode.covariance;
  }
  SpatialRefinement refined_in_space(const MatchPoints&, const Pose3&) override { return {}; }
  Evidence evidence_on_surfaces(const Pose2&, std::span<const ScanRay>) override { return {}; }
  const EvidenceMap& evidence() override { return evidence_; }
  void map_changed(const ChangedBlocks&) override {}

  double support = 0.98;
  std::vector<MatchMode> rivals, elsewhere;

 private:
  Match found() const {
    Match match;
    match.modes = {place(0.0, support)};
    return match;
  }

  OccupancyMap map_;
  EvidenceMap evidence_{map_};
};

// How sure it is of a place, predicted to so much (m).
double sure(Told& told, double sigma_m) {
  const Cloud nothing;
  const PreparedScan scan(nothing);
  const UncertainPose predicted{
      {}, Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, 0.01).asDiagonal()};
  return match_in_reach(told, scan, predicted, 0.995).best();
}

TEST(ReachMatch, IsSureInTheWholeMapOfAPlaceWithoutRivals) {
  Told told;
  EXPECT_GT(sure(told, 4.0), kSureInReach);
}

TEST(ReachMatch, AsksForRivalsInTheWholeMap) {
  Told told;
  told.rivals = {place(3.0, 0.98)};
  EXPECT_GT(sure(told, 0.5), kSureInReach);
  EXPECT_LT(sure(told, 4.0), 0.9);
}

TEST(ReachMatch, LeavesThePlaceToTheMapWhereThePredictionTellsNothing) {
  Told told;
  told.rivals = {place(3.0, 0.98)};
  EXPECT_GT(sure(told, 40.0), kSureInReach);
}

// The robot may well have left what the map shows.
TEST(ReachMatch, BelievesAPoorPlaceLessInTheWholeMapThanInAWindow) {
  Told told;
  told.support = 0.85;
  const double in_window = sure(told, 0.5), anywhere = sure(told, 4.0);
  EXPECT_GT(in_window, kSureInReach);
  EXPECT_LT(anywhere, kSureInReach);
}

// How sure it is of a place in a window, with a look at the rest of the map.
double sure_beside_elsewhere(Told& told) {
  const Cloud nothing;
  const PreparedScan scan(nothing);
  const UncertainPose predicted{{}, Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal()};
  ReachMatch reach = match_in_reach(told, scan, predicted, 0.995);
  weigh_elsewhere(told, scan, 0.995, reach);
  return reach.best();
}

TEST(ReachMatch, DoubtsAPlaceWhereAnotherOneExplainsTheScanFarBetter) {
  Told told;
  told.support = 0.87;
  told.elsewhere = {place(10.0, 0.996)};
  EXPECT_LT(sure_beside_elsewhere(told), 0.5);
}

TEST(ReachMatch, BelievesAPlaceWhereAnotherOneExplainsTheScanAsWell) {
  Told told;
  told.support = 0.98;
  const double alone = sure_beside_elsewhere(told);
  EXPECT_GT(alone, kSureInReach);
  told.elsewhere = {place(10.0, 0.98)};
  EXPECT_GT(sure_beside_elsewhere(told), kSureInReach);
}

// The same place, found again by the search of the whole map, is no other one.
TEST(ReachMatch, TakesNoPlaceForARivalOfItself) {
  Told told;
  told.support = 0.9;
  const double alone = sure_beside_elsewhere(told);
  told.elsewhere = {place(0.05, 0.99)};
  EXPECT_EQ(sure_beside_elsewhere(told), alone);
}

}  // namespace
}  // namespace voxlist::matching
