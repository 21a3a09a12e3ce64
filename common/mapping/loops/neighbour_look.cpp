#include "voxlist/mapping/loops/neighbour_look.h"

#include <algorithm>
#include <utility>

namespace voxlist::mapping {
namespace {

// Neighbours stand in the map as it was made to so much (m, rad), as standard deviations: what a
// tracked scan, or one that joined two pieces, may be off by.
constexpr double kMap_m = 0.3, kMap_rad = 0.02;
// A match of neighbours is taken from this probability on; of 245 pairs of real stations that had
// more, one was off by more than 0.3 m.
constexpr double kTaken = 0.5;
// One that knows all directions so well (m), as between the scans of a drive, is not asked again
// the other way round: of stations, where one was, the two differ by more in half of the pairs.
constexpr double kPlain_m = 0.005;
// So many keyframes are kept ready for the next match.
constexpr std::size_t kKept = 4;

bool is_same(const Pose2& a, const Pose2& b) {
  return a.x_m == b.x_m && a.y_m == b.y_m && a.yaw_rad == b.yaw_rad;
}

}  // namespace

// A keyframe made ready for matching, both ways.
struct NeighbourLooker::Prepared {
  std::size_t number;
  Cloud cloud;
  matching::PreparedScan scan;
  LocalMap map;

  Prepared(std::size_t keyframe, Cloud read, const matching::MatcherConfig& config)
      : number(keyframe), cloud(std::move(read)), scan(cloud, config.scan), map(config) {
    map.add(cloud, {});
  }
};

NeighbourLooker::NeighbourLooker(ReadCloud read, const matching::MatcherConfig& config)
    : read_(std::move(read)), config_(config) {}

NeighbourLooker::~NeighbourLooker() = default;

UncertainPose as_mapped(const Pose2& T_from_to) {
  const Eigen::Vector3d sigma(kMap_m, kMap_m, kMap_rad);
  return {T_from_to, sigma.cwiseAbs2().asDiagonal()};
}

bool is_vague(const UncertainPose& match) {
  // As sure as the map was: what the match began with.
  constexpr double kTold_m = 0.25;
  return worst_sigma_m(match.covariance) > kTold_m;
}

NeighbourLook no_look_yet(const Pose2& T_map_from, const Pose2& T_map_to) {
  return {T_map_from.inverse() * T_map_to, T_map_to.inverse() * T_map_from, {}, {}};
}

bool are_alike(const NeighbourLook& a, const NeighbourLook& b) {
  return is_same(a.expected, b.expected) && is_same(a.expected_back, b.expected_back);
}

NeighbourLook NeighbourLooker::look(std::size_t from, std::size_t to, const Pose2& T_map_from,
                                    const Pose2& T_map_to) {
  NeighbourLook look = no_look_yet(T_map_from, T_map_to);
  look.there = match(to, prepared(from).map, look.expected);
  const bool plain = look.there && worst_sigma_m(look.there->covariance) < kPlain_m;
  if (!plain) look.back = match(from, prepared(to).map, look.expected_back);
  return look;
}

std::optional<UncertainPose> NeighbourLooker::match(std::size_t keyframe, LocalMap& map,
                                                    const Pose2& expected) {
  const matching::ReachMatch found = map.match(prepared(keyframe).scan, as_mapped(expected));
  if (found.best() < kTaken) return std::nullopt;
  const matching::MatchMode& best = found.match.modes.front();
  return UncertainPose{best.pose, best.covariance};
}

// Stays as long as no more than one other is asked for.
NeighbourLooker::Prepared& NeighbourLooker::prepared(std::size_t keyframe) {
  const auto at = std::find_if(kept_.begin(), kept_.end(),
                               [&](const auto& kept) { return kept->number == keyframe; });
  if (at != kept_.end()) {
    std::rotate(at, at + 1, kept_.end());
    return *kept_.back();
  }
  if (kept_.size() == kKept) kept_.pop_front();
  kept_.push_back(std::make_unique<Prepared>(keyframe, read_(keyframe), config_));
  return *kept_.back();
}

}  // namespace voxlist::mapping
