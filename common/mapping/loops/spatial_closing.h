#pragma once

#include "voxlist/mapping/loops/look_memory.h"
#include "voxlist/mapping/loops/session_closing.h"

namespace voxlist::mapping {

/// Whether robots leant or climbed where these were taken.
bool is_in_space(const MapKeyframes& keyframes);

/// Tells the edges of a map in all six coordinates, by the surfaces of the clouds that they join.
/// `poses`: where keyframes stand in the plane; `edges`: those of the drive, one less than
/// keyframes, then loops. Each takes 10 to 30 ms, on the threads of the caller's arena; what the
/// memory knows is not looked at again. `read`: level clouds, asked for one at a time.
void tell_in_space(const MapKeyframes& keyframes, const ReadCloud& read,
                   const matching::MatcherConfig& config, const std::vector<Pose2>& poses,
                   std::vector<PoseEdge>& edges, LookMemory* memory = nullptr);

/// Goes on from a map whose loops are closed in the plane, and whose edges are told in space: all
/// six coordinates are solved. Keyframes are moved where they were in the plane, or where one of
/// them is off by more than 1 cm or 0.1 deg and an edge is missed by more than chance. Which loops
/// are believed was settled in the plane.
void close_in_space(const MapKeyframes& keyframes, SessionClosing& closing);

}  // namespace voxlist::mapping
