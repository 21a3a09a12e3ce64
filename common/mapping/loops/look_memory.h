#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "voxlist/mapping/graph/loop_choice.h"
#include "voxlist/mapping/loops/neighbour_look.h"
#include "voxlist/mapping/loops/spatial_look.h"

namespace voxlist::mapping {

/// All that a look for a loop goes by: where a keyframe is searched for, and in which others.
struct LoopLook {
  std::size_t keyframe = 0;
  double reach_m = 0.0;  ///< of its scan
  /// The old keyframe that is nearest, and T_from_keyframe.
  std::size_t from = 0;
  UncertainPose predicted{};
  /// The old keyframes that it is searched for in, T_from_of each; none: it is not searched for.
  std::vector<std::pair<std::size_t, Pose2>> round{};

  bool operator==(const LoopLook& other) const;
};

/// A look for a loop, and the places that it named, if any.
struct TakenLook {
  LoopLook look;
  std::vector<Loop> places;
};

/// A look in space, and what it found.
struct TakenSpatialLook {
  SpatialLook look;
  std::optional<UncertainPose3> found;
};

/// Looks that were taken, whether they found anything or not: while keyframes stand where they
/// stood, none is taken again. Answers are the same without it. Keyframes keep their numbers.
/// Several threads may use it at once.
class LookMemory {
 public:
  struct Looks {
    std::map<std::pair<std::size_t, std::size_t>, NeighbourLook> neighbours;
    std::map<std::size_t, TakenLook> loops;
    // Two keyframes may be joined by several edges, each looked at from where it expects them.
    std::map<std::pair<std::size_t, std::size_t>, std::vector<TakenSpatialLook>> in_space;
  };

  /// The look at neighbours that were expected there.
  std::optional<NeighbourLook> neighbours(std::size_t from, std::size_t to,
                                          const NeighbourLook& expected) const;
  void keep(std::size_t from, std::size_t to, const NeighbourLook& look);

  /// The last look for a loop from a keyframe.
  std::optional<TakenLook> loop_look(std::size_t keyframe) const;
  void keep(TakenLook look);

  /// The look in space that goes by the same; nothing where none was taken.
  std::optional<TakenSpatialLook> in_space(const SpatialLook& look) const;
  void keep(TakenSpatialLook look);

  /// All that it knows, for whoever keeps it elsewhere (stored_looks.h), and that again.
  Looks all() const;
  void take(Looks looks);

  /// Keyframes have other numbers now.
  void clear();

 private:
  mutable std::mutex mutex_;
  Looks looks_;
};

}  // namespace voxlist::mapping
