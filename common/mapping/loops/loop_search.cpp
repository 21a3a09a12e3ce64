#include "voxlist/mapping/loops/loop_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>
#include <utility>

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
  Search(const PoseTree& tree, const ReadCloud& read, const matching::MatcherConfig& config,
         LookMemory* memory, const DriveHeights& heights_m)
      : tree_(tree), read_(read), config_(config), memory_(memory), heights_m_(heights_m) {}

  // Several threads at once, the same for any number of them.
  std::vector<Loop> find() const {
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
    const auto known = memory_ ? memory_->loop_look(keyframe) : std::nullopt;
    if (known && known->look == look(keyframe, known->look.reach_m)) return known->places;
    const Cloud cloud = read_(keyframe);
    const matching::PreparedScan scan(cloud, config_.scan);
    const LoopLook now = look(keyframe, scan.reach_m());
    std::vector<Loop> places;
    if (!now.round.empty()) places = places_named(now, scan);
    if (memory_) memory_->keep({now, places});
    return places;
  }

  // What a look goes by; round nothing where the keyframe sees no ground of long before.
  LoopLook look(std::size_t keyframe, double reach_m) const {
    LoopLook look{keyframe, reach_m};
    const auto old = nearest_open(keyframe, reach_m);
    if (!old) return look;
    look.from = *old;
    look.predicted = in_window(tree_.between(*old, keyframe));
    look.round = round(*old, keyframe);
    return look;
  }

  std::vector<Loop> places_named(const LoopLook& look, const matching::PreparedScan& scan) const {
    const double told_m = kTold * worst_sigma_m(look.predicted.covariance);
    LocalMap map(config_);
    for (const auto& [i, T_from_i] : look.round) map.add(read_(i), T_from_i);
    const auto found = map.match(scan, look.predicted);
    const auto& modes = found.match.modes;
    std::vector<Loop> loops;
    for (std::size_t i = 0; i < modes.size() && loops.size() < kMostPlaces; ++i)
      if (worst_sigma_m(modes[i].covariance) <= told_m)
        loops.push_back(loop(look.from, look.keyframe, modes[i], found.probabilities[i]));
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

  // Whether the drive tells too little of how they stand, by a long way or by a vague step, and
  // they may see the same.
  bool is_open(std::size_t a, std::size_t b) const {
    if (!may_share_floor(heights_m_, a, b)) return false;
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

  // Old keyframes round one of them, and where they stand as it sees them.
  std::vector<std::pair<std::size_t, Pose2>> round(std::size_t centre, std::size_t keyframe) const {
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < tree_.size(); ++i)
      if (tree_.way_m(centre, i) <= kRound_m && is_open(i, keyframe)) near.push_back(i);
    const auto away_m = [&](std::size_t i) {
      return distance_m(tree_.pose(i), tree_.pose(centre));
    };
    std::stable_sort(near.begin(), near.end(),
                     [&](std::size_t a, std::size_t b) { return away_m(a) < away_m(b); });
    std::vector<std::pair<std::size_t, Pose2>> taken;
    for (const std::size_t i : near) {
      if (taken.size() == kMostKeyframes) break;
      const bool apart = std::all_of(taken.begin(), taken.end(), [&](const auto& other) {
        return distance_m(tree_.pose(i), tree_.pose(other.first)) >= kApart_m;
      });
      if (apart) taken.emplace_back(i, tree_.between(centre, i).pose);
    }
    return taken;
  }

  const PoseTree& tree_;
  const ReadCloud& read_;
  const matching::MatcherConfig config_;
  LookMemory* const memory_;
  const DriveHeights& heights_m_;
};

}  // namespace

bool is_long_way(double way_m, double away_m) {
  // A drive drifts by 2 cm or so over this way, which local maps hide.
  constexpr double kOld_m = 30.0;
  return way_m > kOld_m + away_m;
}

std::vector<Loop> find_loops(const PoseTree& tree, const ReadCloud& read,
                             const matching::MatcherConfig& config, LookMemory* memory,
                             const DriveHeights& heights_m) {
  return Search(tree, read, config, memory, heights_m).find();
}

}  // namespace voxlist::mapping
