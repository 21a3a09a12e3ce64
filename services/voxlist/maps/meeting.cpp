#include "services/voxlist/maps/meeting.h"

#include <algorithm>
#include <map>
#include <set>

#include "services/voxlist/maps/piece_closing.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/mapping/loops/local_map.h"
#include "voxlist/mapping/loops/neighbour_look.h"

namespace voxlist::desk {
namespace {

// It is asked from keyframes so far (m) apart: what a scan shows changes with the place.
constexpr double kEach_m = 2.0;
constexpr std::size_t kMostSearches = 60;
// Before a scan is looked at, it was taken where the map is with this probability.
constexpr double kHere = 0.5;
// What one scan says of the other map's place is looked into from this probability on.
constexpr double kHint = 0.5;
constexpr std::size_t kMostHints = 8;
// So is what the same scan says of other places: where one does as well, in a wing that is the same
// from both of its ends, the likeliest is right by luck.
constexpr double kRival = 0.01;
// A scan that was taken as near to one of the map's as this share of how far it reaches sees mostly
// the map's ground.
constexpr double kMeetsShare = 0.5;
// It is looked for there by so much (m, rad): both maps are bent a little.
constexpr double kBent_m = 0.3, kBent_rad = 0.02;
// So many of the map's keyframes are matched with.
constexpr std::size_t kRound = 4;
// Scans fit where they are right rather than not. So many must, and such a share of those on the
// map's ground, as for loops (mapping/graph/loop_choice.cpp).
constexpr double kFits = 0.5;
constexpr std::size_t kFewest = 4;
constexpr double kLeastShare = 0.6;
// Two places are one if a scan fits both within this (m, rad).
constexpr double kSame_m = 0.5, kSame_rad = 0.3;
// So many of the places that a search names for a scan are looked into for its twins.
constexpr std::size_t kMostTwins = 8;
// A twin is a place that a robot which is expected there would be sure of. In the hall of the
// tests, whose pillars stand in a grid, 8 of 15 scans fit elsewhere rather than not, and 2 surely;
// in wings of offices that are alike, all do.
constexpr double kTwin = matching::kSureInReach;

// What speaks for one place.
struct Place {
  Pose2 T_map_other{};
  std::size_t asked = 0;
  // T_map_base of each of the other's keyframes that fits.
  std::map<std::size_t, Pose2> fitting;
  // Those of them that fit all along a corridor.
  std::set<std::size_t> vague;
  // Those that are not vague and fit elsewhere in the map, too.
  std::size_t twins = 0;

  bool enough() const { return are_enough(fitting.size()); }

  // Where what is seen is there twice, the building may well have it a third time outside the map:
  // such scans speak for no place, though they are asked. Vague ones speak for many.
  bool enough_that_tell() const {
    return are_enough(fitting.size() - twins) && fitting.size() - twins - vague.size() >= kFewest;
  }

  bool are_enough(std::size_t scans) const {
    return scans >= kFewest &&
           static_cast<double>(scans) >= kLeastShare * static_cast<double>(asked);
  }

  bool is(const Place& place) const {
    return std::any_of(fitting.begin(), fitting.end(), [&](const auto& fit) {
      const auto at = place.fitting.find(fit.first);
      return at != place.fitting.end() && distance_m(at->second, fit.second) < kSame_m;
    });
  }
};

struct Hint {
  double probability;
  Pose2 T_map_other;
};

class Search {
 public:
  Search(mapping::Piece& map, const mapping::Piece& other, mapping::KeyframeSpool& spool,
         const matching::MatcherConfig& config)
      : map_(map), other_(other), spool_(spool), config_(config) {
    for (std::size_t i = 0; i < other.keyframes().size(); ++i)
      if (asked_.empty() || distance_m(pose(other, asked_.back()), pose(other, i)) >= kEach_m)
        asked_.push_back(i);
  }

  Meeting find() {
    std::vector<Place> places;
    for (const Hint& hint : hints()) {
      if (stop_requested() || places.size() == kMostHints) break;
      if (!is_known(places, hint)) places.push_back(look_into(hint.T_map_other));
    }
    return judge(places);
  }

 private:
  static Pose2 pose(const mapping::Piece& piece, std::size_t i) {
    return to_pose2(piece.keyframes()[i].T_map_base);
  }

  // What single scans say, the surest first.
  std::vector<Hint> hints() {
    std::vector<Hint> hints;
    const std::size_t each = asked_.size() / kMostSearches + 1;
    for (std::size_t i = 0; i < asked_.size() && !stop_requested(); i += each) {
      const auto found =
          map_.localiser().recognise(level_cloud(spool_, other_.keyframes()[asked_[i]]), kHere);
      std::vector<Pose2>& named = named_[asked_[i]];
      for (const matching::PoseMode& mode : found.modes) named.push_back(mode.T_map_base);
      if (found.modes.empty() || found.confidence < kHint) continue;
      for (const matching::PoseMode& mode : found.modes)
        if (mode.probability >= kRival)
          hints.push_back({mode.probability, mode.T_map_base * pose(other_, asked_[i]).inverse()});
    }
    std::stable_sort(hints.begin(), hints.end(),
                     [](const Hint& a, const Hint& b) { return a.probability > b.probability; });
    return hints;
  }

  // Whether it says what a place says that was looked into.
  bool is_known(const std::vector<Place>& places, const Hint& hint) const {
    return std::any_of(places.begin(), places.end(), [&](const Place& place) {
      return std::any_of(place.fitting.begin(), place.fitting.end(), [&](const auto& fit) {
        return distance_m(fit.second, hint.T_map_other * pose(other_, fit.first)) < kSame_m;
      });
    });
  }

  Place look_into(const Pose2& T_map_other) {
    Place place;
    place.T_map_other = T_map_other;
    for (const std::size_t i : asked_) {
      const Pose2 T_map_base = T_map_other * pose(other_, i);
      const Cloud cloud = level_cloud(spool_, other_.keyframes()[i]);
      const matching::PreparedScan scan(cloud, config_.scan);
      const std::vector<std::size_t> round = map_round(T_map_base);
      if (distance_m(pose(map_, round.front()), T_map_base) > kMeetsShare * scan.reach_m())
        continue;
      ++place.asked;
      const auto fit = fitted(round, scan, T_map_base, kFits);
      if (!fit) continue;
      place.fitting.emplace(i, fit->pose);
      if (mapping::is_vague(*fit)) place.vague.insert(i);
    }
    return place;
  }

  // Searches named the places that each scan may be at.
  std::size_t count_twins(const Place& place) {
    return static_cast<std::size_t>(
        std::count_if(place.fitting.begin(), place.fitting.end(), [&](const auto& fit) {
          return !place.vague.contains(fit.first) && has_twin(fit.first, fit.second);
        }));
  }

  bool has_twin(std::size_t keyframe, const Pose2& T_map_base) {
    const Cloud cloud = level_cloud(spool_, other_.keyframes()[keyframe]);
    const matching::PreparedScan scan(cloud, config_.scan);
    const std::vector<Pose2>& named = named_[keyframe];
    const auto end =
        named.begin() + static_cast<std::ptrdiff_t>(std::min(kMostTwins, named.size()));
    return std::any_of(named.begin(), end, [&](const Pose2& there) {
      if (is_same(there, T_map_base)) return false;
      const auto fit = fitted(map_round(there), scan, there, kTwin);
      return fit && !is_same(fit->pose, T_map_base);
    });
  }

  static bool is_same(const Pose2& a, const Pose2& b) {
    return distance_m(a, b) < kSame_m && turn_rad(a, b) < kSame_rad;
  }

  // The map's keyframes nearest to a pose, the nearest first.
  std::vector<std::size_t> map_round(const Pose2& T_map_base) const {
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t i = 0; i < map_.keyframes().size(); ++i)
      near.emplace_back(distance_m(pose(map_, i), T_map_base), i);
    const std::size_t round = std::min(kRound, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(round), near.end());
    std::vector<std::size_t> taken;
    for (std::size_t i = 0; i < round; ++i) taken.push_back(near[i].second);
    return taken;
  }

  std::optional<UncertainPose> fitted(const std::vector<std::size_t>& round,
                                      const matching::PreparedScan& scan, const Pose2& T_map_base,
                                      double least) {
    const Pose2 T_map_local = pose(map_, round.front());
    mapping::LocalMap map(config_);
    for (const std::size_t i : round)
      map.add(level_cloud(spool_, map_.keyframes()[i]), T_map_local.inverse() * pose(map_, i));
    const Eigen::Vector3d bent(kBent_m, kBent_m, kBent_rad);
    const auto found =
        map.match(scan, {T_map_local.inverse() * T_map_base, bent.cwiseAbs2().asDiagonal()});
    if (found.best() < least) return std::nullopt;
    const matching::MatchMode& best = found.match.modes.front();
    return UncertainPose{T_map_local} * UncertainPose{best.pose, best.covariance};
  }

  Meeting judge(std::vector<Place>& places) {
    const auto best = std::max_element(
        places.begin(), places.end(),
        [](const Place& a, const Place& b) { return a.fitting.size() < b.fitting.size(); });
    if (best == places.end()) return {};
    Meeting meeting{std::nullopt, best->asked, best->fitting.size()};
    meeting.alike = std::any_of(places.begin(), places.end(), [&](const Place& place) {
      return &place != &*best && place.enough() && !place.is(*best);
    });
    if (!best->enough() || meeting.alike) return meeting;
    meeting.twins = best->twins = count_twins(*best);
    meeting.vague = best->vague.size();
    if (best->enough_that_tell()) meeting.T_map_other = best->T_map_other;
    return meeting;
  }

  mapping::Piece& map_;
  const mapping::Piece& other_;
  mapping::KeyframeSpool& spool_;
  const matching::MatcherConfig config_;
  std::vector<std::size_t> asked_;
  // T_map_base of the places that a search of the map named for the other's keyframes.
  std::map<std::size_t, std::vector<Pose2>> named_;
};

}  // namespace

Meeting find_meeting(mapping::Piece& map, const mapping::Piece& other,
                     mapping::KeyframeSpool& spool, const matching::MatcherConfig& config) {
  return Search(map, other, spool, config).find();
}

}  // namespace voxlist::desk
