#include "voxlist/mapping/loops/loop_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>

namespace voxlist::mapping {
namespace {

// It is looked from keyframes so far (m) apart: what a scan shows changes with the place.
constexpr double kEach_m = 2.0;
// A local map holds so many keyframes round the nearest one, as far from it (m, of the way) and
// from each other.
constexpr std::size_t kMostKeyframes = 4;
constexpr double kRound_m = 20.0, kApart_m = 1.0;
// So many places a look may name; the right one was among them for 5 of 8 real stations that saw
// others from 21 to 41 m away, and first for 3.
constexpr std::size_t kMostPlaces = 3;
// A place is told that is known so much better than the drive knows it, in the direction that it is
// known least. A match holds its pose by the drive's, too: so that counts again by 1 of 64 at most.
constexpr double kTold = 1.0 / 8.0;
// What local maps are off by in themselves (m, rad), beside what a match tells.
constexpr double kLocal_m = 0.02, kLocal_rad = 0.002;

// Keyframes that stand so vaguely to each other (m) are looked for as those of long before: a match
// of neighbours is surer, so a step between them was told by none.
constexpr double kUnsure_m = 0.25;

// A prediction that is vaguer than a window may be (m, as a standard deviation) is looked for in
// the widest window.
constexpr double kVaguest_m = 1.5;

UncertainPose in_window(UncertainPose predicted) {
  const double sigma_m = worst_sigma_m(predicted.covariance);
  if (sigma_m > kVaguest_m) predicted.covariance *= kVaguest_m * kVaguest_m / (sigma_m * sigma_m);
  return predicted;
}

class Search {
 public:
  Search(const PoseTree& tree, const ReadCloud& read, const matching::MatcherConfig& config)
      : tree_(tree), read_(read), config_(config) {}

  // Several threads at once, the same for any number of them.
  std::vector<Loop> look() const {
    const std::vector<std::size_t> from = places();
    std::vector<std::vector<Loop>> found(from.size());
    tbb::parallel_for(std::size_t{0}, from.size(),
                      [&](std::size_t i) { found[i] = look_from(from[i]); });
    std::vector<Loop> all;
    for (const auto& loops : found) all.insert(all.end(), loops.begin(), loops.end());
    return all;
  }

 private:
  std::vector<std::size_t> places() const {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < tree_.size(); ++i)
      if (places.empty() || tree_.way_m(places.back(), i) >= kEach_m) places.push_back(i);
    return places;
  }

  std::vector<Loop> look_from(std::size_t keyframe) const {
    if (!nearest_open(keyframe, config_.scan.max_range_m)) return {};
    const Cloud cloud = read_(keyframe);
    const matching::PreparedScan scan(cloud, config_.scan);
    const auto old = nearest_open(keyframe, scan.reach_m());
    if (!old) return {};
    const UncertainPose predicted = in_window(tree_.between(*old, keyframe));
    const double told_m = kTold * worst_sigma_m(predicted.covariance);
    const auto found = map_round(*old, keyframe).match(scan, predicted);
    const auto& modes = found.match.modes;
    std::vector<Loop> loops;
    for (std::size_t i = 0; i < modes.size() && loops.size() < kMostPlaces; ++i)
      if (worst_sigma_m(modes[i].covariance) <= told_m)
        loops.push_back(loop(*old, keyframe, modes[i], found.probabilities[i]));
    return loops;
  }

  static Loop loop(std::size_t from, std::size_t to, const matching::MatchMode& mode,
                   double probability) {
    UncertainPose T_from_to{mode.pose, mode.covariance};
    T_from_to.covariance.diagonal() += Eigen::Vector3d(kLocal_m, kLocal_m, kLocal_rad).cwiseAbs2();
    // Both ends in the order of time, so that looks from either compare.
    const PoseEdge edge{from, to, T_from_to};
    return {from < to ? edge : reversed(edge), to, probability};
  }

  // Whether the drive tells too little of how they stand: by a long way, or by a vague step.
  bool is_open(std::size_t a, std::size_t b) const {
    return is_long_way(tree_.way_m(a, b), distance_m(tree_.pose(a), tree_.pose(b))) ||
           worst_sigma_m(tree_.between(a, b).covariance) > kUnsure_m;
  }

  std::optional<std::size_t> nearest_open(std::size_t keyframe, double within_m) const {
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < tree_.size(); ++i) {
      const double away_m = distance_m(tree_.pose(i), tree_.pose(keyframe));
      if (away_m > within_m || !is_open(i, keyframe)) continue;
      nearest = i;
      within_m = away_m;
    }
    return nearest;
  }

  LocalMap map_round(std::size_t centre, std::size_t keyframe) const {
    std::vector<std::size_t> round;
    for (std::size_t i = 0; i < tree_.size(); ++i)
      if (tree_.way_m(centre, i) <= kRound_m && is_open(i, keyframe)) round.push_back(i);
    const auto away_m = [&](std::size_t i) {
      return distance_m(tree_.pose(i), tree_.pose(centre));
    };
    std::stable_sort(round.begin(), round.end(),
                     [&](std::size_t a, std::size_t b) { return away_m(a) < away_m(b); });
    LocalMap map(config_);
    std::vector<std::size_t> taken;
    for (const std::size_t i : round) {
      if (taken.size() == kMostKeyframes) break;
      const bool apart = std::all_of(taken.begin(), taken.end(), [&](std::size_t other) {
        return distance_m(tree_.pose(i), tree_.pose(other)) >= kApart_m;
      });
      if (!apart) continue;
      map.add(read_(i), tree_.between(centre, i).pose);
      taken.push_back(i);
    }
    return map;
  }

  const PoseTree& tree_;
  const ReadCloud& read_;
  const matching::MatcherConfig config_;
};

}  // namespace

bool is_long_way(double way_m, double away_m) {
  // A drive drifts by 2 cm or so over this way, which local maps hide.
  constexpr double kOld_m = 30.0;
  return way_m > kOld_m + away_m;
}

std::vector<Loop> find_loops(const PoseTree& tree, const ReadCloud& read,
                             const matching::MatcherConfig& config) {
  return Search(tree, read, config).look();
}

}  // namespace voxlist::mapping
