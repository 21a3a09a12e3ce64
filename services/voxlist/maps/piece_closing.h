#pragma once

#include "services/voxlist/maps/ahead/look_ahead.h"
#include "voxlist/drawing/map_picture.h"
#include "voxlist/mapping/loops/session_closing.h"
#include "voxlist/mapping/pieces/piece.h"

namespace voxlist::desk {

/// What closing a piece's loops came to.
struct PieceClosing {
  std::size_t loops = 0, refused = 0;
  /// How far the keyframe was moved that was moved farthest (m).
  double moved_m = 0.0;
  drawing::ClosedLoops drawn;
  /// Where the keyframes stand now, and what holds them; of no map yet.
  mapping::StoredGraph graph;
};

/// A keyframe's cloud as a level robot has it: poses are searched for in the plane.
Cloud level_cloud(mapping::KeyframeSpool& spool, const mapping::SpooledKeyframe& keyframe);

/// Closes the loops of a piece, whose keyframes are all in the spool: where its drive came back to
/// ground of long before, its keyframes go where all scans agree, and its map is made anew. The
/// keyframe that is the piece's origin stays. `looks`: of its keyframes, taken before; the answer
/// is the same without them.
PieceClosing close_piece(mapping::Piece& piece, mapping::KeyframeSpool& spool,
                         const matching::MatcherConfig& config, const LookAhead::Looks& looks = {});

}  // namespace voxlist::desk
