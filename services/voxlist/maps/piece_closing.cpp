#include "services/voxlist/maps/piece_closing.h"

namespace voxlist::desk {
namespace {

mapping::MapKeyframes keyframes_of(const mapping::Piece& piece) {
  mapping::MapKeyframes keyframes;
  for (std::size_t i = 0; i < piece.keyframes().size(); ++i) {
    const mapping::SpooledKeyframe& keyframe = piece.keyframes()[i];
    keyframes.push_back({piece.builder().poses()[i].utime_us, to_pose2(keyframe.T_map_base),
                         keyframe.T_odom_base, i > 0 && i == piece.first_session(),
                         tilt_of(keyframe.T_map_base)});
  }
  return keyframes;
}

std::vector<Pose3> poses_of(const mapping::MapKeyframes& keyframes) {
  std::vector<Pose3> poses;
  for (const auto& keyframe : keyframes)
    poses.push_back(to_pose3(keyframe.T_map_keyframe, *keyframe.tilt));
  return poses;
}

}  // namespace

Cloud level_cloud(mapping::KeyframeSpool& spool, const mapping::SpooledKeyframe& keyframe) {
  return mapping::level_cloud(spool.read(keyframe));
}

PieceClosing close_piece(mapping::Piece& piece, mapping::KeyframeSpool& spool,
                         const matching::MatcherConfig& config, const LookAhead::Looks& looks) {
  const auto& keyframes = piece.keyframes();
  const auto known = [&](std::size_t from, std::size_t to) {
    const auto at = looks.find({keyframes[from].index, keyframes[to].index});
    return at == looks.end() ? nullptr : &at->second;
  };
  const mapping::MapKeyframes before = keyframes_of(piece);
  const auto read = [&](std::size_t i) { return level_cloud(spool, keyframes[i]); };
  mapping::SessionClosing closed = mapping::close_sessions(before, read, config, known);
  if (closed.edges.empty()) closed.edges = mapping::drive_edges(before, read, config, known);
  if (closed.moves) piece.move_keyframes(poses_of(mapping::moved(before, closed)));
  return {closed.loops,
          closed.refused,
          closed.moved_m,
          mapping::drawn(before, closed),
          {0, 0, keyframes_of(piece), closed.edges}};
}

}  // namespace voxlist::desk
