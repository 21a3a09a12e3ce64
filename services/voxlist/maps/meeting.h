#pragma once

#include <cstddef>
#include <optional>

#include "voxlist/mapping/pieces/piece.h"

namespace voxlist::desk {

/// Where another map lies in a map, by what its scans see.
struct Meeting {
  /// Nothing when it is not sure.
  std::optional<Pose2> T_map_other;
  /// The other's scans that were taken on the map's ground, by the likeliest place, and those of
  /// them that fit it there.
  std::size_t asked = 0, fitting = 0;
  /// Those of the fitting ones that fit elsewhere in the map as well, and say nothing therefore;
  /// counted where all else is sure.
  std::size_t twins = 0;
  /// Others of the fitting ones that fit all along a corridor, and do not say where on it they were
  /// taken; counted where all else is sure.
  std::size_t vague = 0;
  /// Whether another place would do as well.
  bool alike = false;
};

/// Searches a map for the scans of another one. No scan is believed by itself: four at least that
/// stand 2 m apart must fit where one of them says that the other map lies, and most of all that
/// were taken on the map's ground by that. Scans that fit a second place, too, as in a wing of
/// offices that are alike, count for none, nor do those that nothing holds in some direction, as
/// along a bare corridor. Searches take 0.1 to 1 s each, 60 at most.
Meeting find_meeting(mapping::Piece& map, const mapping::Piece& other,
                     mapping::KeyframeSpool& spool, const matching::MatcherConfig& config);

}  // namespace voxlist::desk
