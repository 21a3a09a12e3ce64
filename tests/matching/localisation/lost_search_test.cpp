#include "voxlist/matching/localisation/lost_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "tests/matching/synthetic_room.h"

namespace voxlist::matching {
namespace {

// Finds one pose, however it is asked, and counts how often it is asked for rivals.
class OnePose : public Matcher {
 public:
  OnePose(const OccupancyMap& map, const Pose2& pose, double unseen)
      : evidence_(map), unseen_(unseen) {
    mode_.pose = pose;
  }

  Match match(const PreparedScan&, const std::optional<PoseWindow>& window) override {
    Match match;
    match.modes.push_back(mode_);
    if (!window && elsewhere) match.modes.back().pose = *elsewhere;
    match.unseen = unseen_;
    return match;
  }
  Match track(const PreparedScan& scan, const std::optional<PoseWindow>& window,
              const UncertainPose&) override {
    Match match = this->match(scan, window);
    match.modes.front().covariance = held;
    return match;
  }
  Eigen::Matrix3d covariance_without_lines(const PreparedScan&, const MatchMode&,
                                           const UncertainPose&) override {
    return held;
  }
  Match match_rivals(const PreparedScan& scan) override {
    ++asked;
    return match(scan, std::nullopt);
  }
  SpatialRefinement refined_in_space(const MatchPoints&, const Pose3& start) override {
    SpatialRefinement refined;
    refined.pose = start;
    return refined;
  }

  Evidence evidence_on_surfaces(const Pose2&, std::span<const ScanRay>) override { return {}; }
  const EvidenceMap& evidence() override { return evidence_; }
  void map_changed(const ChangedBlocks&) override {}

  int asked = 0;
  // What the search of the whole map lists instead.
  std::optional<Pose2> elsewhere;
  // What a refinement that knows nothing beforehand has of the pose.
  Eigen::Matrix3d held = Eigen::Matrix3d::Zero();

 private:
  const EvidenceMap evidence_;
  MatchMode mode_;
  const double unseen_;
};

struct Lost {
  OccupancyMap map;
  Cloud scan;
  Pose2 truth{3.0, 2.0, 0.3};

  // The scan has a share of points in the middle of nowhere that the map knows to be free.
  explicit Lost(double share_elsewhere) {
    const RoomSurfaces room(6.0, 4.0, 0, 1);
    room.sample(0.015, [&](const Eigen::Vector3d& p) {
      map.occupied.insert(voxel_at(p, kFinestResolution_m));
    });
    int i = 0;
    room.sample(0.15, [&](const Eigen::Vector3d& p) {
      const bool elsewhere =
          static_cast<int>(share_elsewhere * i) != static_cast<int>(share_elsewhere * (i + 1));
      ++i;
      const Eigen::Vector3d at = elsewhere ? Eigen::Vector3d(p.x(), p.y() + 10.0, p.z()) : p;
      if (elsewhere) map.passed.insert(voxel_at(at, map.passed.resolution_m()));
      scan.points.push_back((truth.inverse() * at).cast<float>());
    });
  }

  Localisation find(OnePose& matcher,
                    const std::optional<UncertainPose>& hint = std::nullopt) const {
    return LostSearch({}, {}).add(PreparedScan(scan), std::nullopt, matcher, hint);
  }
};

TEST(LostSearch, IsSureOfAPoseThatExplainsAllAndStandsAlone) {
  const Lost lost(0.0);
  OnePose matcher(lost.map, lost.truth, 0.88);
  EXPECT_TRUE(lost.find(matcher).tracking());
  EXPECT_EQ(matcher.asked, 0);
}

// Somebody puts a robot, whose wheels stand, from a place that the map does not know into one that
// it does.
TEST(LostSearch, FindsAtOnceARobotThatWasCarriedWhileItsWheelsStood) {
  const Lost away(1.0), back(0.0);
  OnePose matcher(away.map, back.truth, 0.88);
  LostSearch search({}, {});
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(search.add(PreparedScan(away.scan), Pose2{}, matcher).state,
              LocalisationState::kLost);
  EXPECT_TRUE(search.add(PreparedScan(back.scan), Pose2{}, matcher).tracking());
}

// The sweep in which it is carried shows some of both places, whichever more of.
TEST(LostSearch, JudgesTheScanAfterTheOneInWhichItWasCarriedByItself) {
  const Lost away(1.0), back(0.0);
  for (const std::size_t share : {2, 4}) {
    OnePose matcher(away.map, back.truth, 0.88);
    LostSearch search({}, {});
    search.add(PreparedScan(away.scan), Pose2{}, matcher);
    Cloud both = back.scan;
    for (std::size_t i = 0; i < both.points.size(); i += share)
      both.points[i] = away.scan.points[i];
    EXPECT_FALSE(search.add(PreparedScan(both), Pose2{}, matcher).tracking());
    EXPECT_TRUE(search.add(PreparedScan(back.scan), Pose2{}, matcher).tracking());
  }
}

// As along a corridor: the place is right, and no surface tells where in it.
TEST(LostSearch, TellsNoPoseThatNoSurfaceHolds) {
  const Lost lost(0.0);
  OnePose matcher(lost.map, lost.truth, 0.88);
  matcher.held(0, 0) = 1.0;
  const Localisation found = lost.find(matcher);
  EXPECT_EQ(found.state, LocalisationState::kAmbiguous);
  ASSERT_EQ(found.modes.size(), 1u);
  EXPECT_EQ(found.modes.front().covariance(0, 0), 1.0);
}

TEST(LostSearch, AsksForRivalsOfAPoseThatDoesNotExplainAll) {
  const Lost lost(0.15);
  OnePose matcher(lost.map, lost.truth, 0.88);
  lost.find(matcher);
  EXPECT_EQ(matcher.asked, 1);
}

TEST(LostSearch, IsNeverSureAfterASearchThatDidNotEnd) {
  const Lost lost(0.0);
  OnePose matcher(lost.map, lost.truth, 1.0);
  const Localisation found = lost.find(matcher);
  EXPECT_EQ(matcher.asked, 0);
  EXPECT_FALSE(found.tracking());
}

UncertainPose hint_at(const Pose2& pose) {
  return {pose, Eigen::Vector3d(0.25, 0.25, 0.07).asDiagonal()};
}

bool lists(const Localisation& found, const Pose2& pose) {
  return std::any_of(found.modes.begin(), found.modes.end(),
                     [&](const PoseMode& mode) { return mode.T_map_base == pose; });
}

TEST(LostSearch, WeighsAPlaceNearAHintThatTheSearchMissed) {
  const Lost lost(0.0);
  OnePose matcher(lost.map, lost.truth, 0.88);
  matcher.elsewhere = lost.truth * Pose2{1.0, 0.5, 0.5};
  EXPECT_FALSE(lists(lost.find(matcher), lost.truth));
  const Localisation found = lost.find(matcher, hint_at(lost.truth));
  ASSERT_FALSE(found.modes.empty());
  EXPECT_EQ(found.modes.front().T_map_base, lost.truth);
  EXPECT_TRUE(found.tracking());
}

TEST(LostSearch, AHintMakesNoPlaceSureThatWouldNotBeWithoutIt) {
  const Lost lost(0.0);
  OnePose matcher(lost.map, lost.truth, 1.0);
  EXPECT_FALSE(lost.find(matcher, hint_at(lost.truth)).tracking());
}

TEST(LostSearch, PassesOverAHintAtWhichNothingFits) {
  const Lost lost(0.0);
  const Pose2 elsewhere = lost.truth * Pose2{1.0, 0.5, 0.5};
  OnePose matcher(lost.map, elsewhere, 0.88);
  matcher.elsewhere = lost.truth;
  const Localisation found = lost.find(matcher, hint_at(elsewhere));
  ASSERT_FALSE(found.modes.empty());
  EXPECT_EQ(found.modes.front().T_map_base, lost.truth);
  EXPECT_FALSE(lists(found, elsewhere));
}

}  // namespace
}  // namespace voxlist::matching
