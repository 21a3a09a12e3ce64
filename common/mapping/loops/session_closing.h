#pragma once

#include <vector>

#include "voxlist/drawing/map_picture.h"
#include "voxlist/mapping/graph/stored_graph.h"
#include "voxlist/mapping/loops/map_closing.h"

namespace voxlist::mapping {

/// A map's keyframes in the order of their file, as they stand.
using MapKeyframes = std::vector<StoredGraph::Keyframe>;

/// What closing the loops of a map came to, whose keyframes are of several sessions.
struct SessionClosing {
  /// T_map_keyframe of each; as they were where nothing is to be closed.
  std::vector<Pose2> poses;
  /// Height, roll and pitch of each, where those are moved, too; else empty.
  std::vector<Tilt> tilts;
  /// What holds them, where it was looked for: by the drive, then by loops.
  std::vector<PoseEdge> edges;
  std::size_t loops = 0, refused = 0;
  /// How far the keyframe is moved that is moved farthest (m), and that is turned farthest (rad).
  double moved_m = 0.0, turned_rad = 0.0;
  bool moves = false;
};

/// Keyframes that stand where a closing has them.
MapKeyframes moved(MapKeyframes keyframes, const SessionClosing& closing);

/// The order in which they came: session by session, each in the order of time.
std::vector<std::size_t> order_of_drive(const MapKeyframes& keyframes);

/// Closes the loops of a map, all sessions taken as one drive: in the plane, and then in height,
/// roll and pitch (spatial_closing.h) where robots lean. The first keyframe stays. `read`
/// and `known` (looks that were taken before, as close_map() has them) take keyframes' places in
/// `keyframes`; those of the memory are in the order of the drive, or in space those
/// in `keyframes`.
SessionClosing close_sessions(const MapKeyframes& keyframes, const ReadCloud& read,
                              const matching::MatcherConfig& config, const KnownLook& known = {},
                              LookMemory* memory = nullptr);

/// What the drive's own way says of the keyframes: what holds a map that never came back, a match
/// for each keyframe and its neighbour.
std::vector<PoseEdge> drive_edges(const MapKeyframes& keyframes, const ReadCloud& read,
                                  const matching::MatcherConfig& config,
                                  const KnownLook& known = {});

/// What a picture of the map shows of that: nothing where nothing moves.
drawing::ClosedLoops drawn(const MapKeyframes& before, const SessionClosing& closing);

/// A keyframe's cloud as a level robot has it: poses are searched for in the plane.
Cloud level_cloud(const Keyframe& keyframe);

}  // namespace voxlist::mapping
