#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include "voxlist/geometry/uncertain_pose.h"
#include "voxlist/mapping/loops/local_map.h"

namespace voxlist::mapping {

/// How two keyframes stand to each other by their scans, each matched in the map of the other.
struct NeighbourLook {
  /// T_from_to and T_to_from where they were looked for.
  Pose2 expected, expected_back;
  std::optional<UncertainPose> there;  ///< T_from_to
  std::optional<UncertainPose> back;   ///< T_to_from
};

/// A look that was taken before, or nullptr. Several threads may ask at once.
using KnownLook = std::function<const NeighbourLook*(std::size_t from, std::size_t to)>;

/// Matches keyframes with each other, and keeps some of them ready for the next match. The same
/// keyframes, expected at the same place, give the same bits. One thread at a time.
class NeighbourLooker {
 public:
  NeighbourLooker(ReadCloud read, const matching::MatcherConfig& config);
  ~NeighbourLooker();

  /// `from` and `to` stand at these poses.
  NeighbourLook look(std::size_t from, std::size_t to, const Pose2& T_map_from,
                     const Pose2& T_map_to);

  /// A scan in a map of others, near where it is expected, be it vague; nothing where it does not
  /// fit.
  std::optional<UncertainPose> match(std::size_t keyframe, LocalMap& map, const Pose2& expected);

 private:
  struct Prepared;

  Prepared& prepared(std::size_t keyframe);

  const ReadCloud read_;
  const matching::MatcherConfig config_;
  std::deque<std::unique_ptr<Prepared>> kept_;
};

/// Where two keyframes are looked for that stand at these poses, without what is found.
NeighbourLook no_look_yet(const Pose2& T_map_from, const Pose2& T_map_to);

/// Whether two looks are for the same places, bit for bit.
bool are_alike(const NeighbourLook& a, const NeighbourLook& b);

/// Whether a match leaves a direction no surer than the map had it: along a corridor it tells yaw
/// and the way across alone.
bool is_vague(const UncertainPose& match);

/// How two keyframes stand as the map has it: that sure.
UncertainPose as_mapped(const Pose2& T_from_to);

}  // namespace voxlist::mapping
