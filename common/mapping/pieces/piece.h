#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "voxlist/mapping/keyframe_spool.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::mapping {

/// A part of a drive that hangs together: a map with its localiser, in a frame of its own, that of
/// its first scan or of a map that was there before. Its keyframes wait in a spool.
class Piece {
 public:
  /// Is given each keyframe that goes into the map, and odometry's pose then, for whoever keeps
  /// them elsewhere.
  using Keep = std::function<void(const Keyframe&, const std::optional<Pose2>&)>;

  /// The spool must outlive it.
  Piece(const matching::LocaliserConfig& localiser, MapBuilder map, KeyframeSpool& spool);

  /// A piece that leaves nothing in a spool.
  Piece(const matching::LocaliserConfig& localiser, MapBuilder map, Keep keep);
  Piece(const Piece&) = delete;
  Piece& operator=(const Piece&) = delete;

  matching::Localiser& localiser() { return localiser_; }
  const MapBuilder& builder() const { return builder_; }

  /// T_piece_base of every scan that was placed.
  const std::vector<StampedPose3>& trajectory() const { return trajectory_; }

  /// The keyframes in the spool, in the order in which they went into the map.
  const std::vector<SpooledKeyframe>& keyframes() const { return keyframes_; }

  /// Takes a scan at the pose that was found in the piece, and adds it to the map if it tells
  /// something new. Returns whether it did.
  bool take(const Cloud& cloud, const matching::PoseMode& found,
            const std::optional<Pose2>& T_odom_base);

  /// Adds a scan to the map at its pose.
  void add(Cloud cloud, const Pose3& T_piece_base);

  /// Takes edits by hand. No scan is looked for in it afterwards.
  void edit(MapEdits edits) { builder_.edit(std::move(edits)); }

  /// Takes the poses of all scans that were placed, where they were placed elsewhere.
  void set_trajectory(std::vector<StampedPose3> T_piece_base) {
    trajectory_ = std::move(T_piece_base);
  }

  /// What it takes from now on is of another session, later than all before, whatever the times of
  /// both say.
  void begin_session() { second_session_ = {keyframes_.size(), trajectory_.size()}; }

  /// So many keyframes are of the session before; 0 where there is but one.
  std::size_t first_session() const { return second_session_.keyframe; }

  /// Makes the map that of its keyframes at these poses, in their order; other scans keep their
  /// place beside the keyframe of their session that was taken next before or after them.
  void move_keyframes(const std::vector<Pose3>& T_piece_base);

  /// Takes all that another piece has; `T_this_other` is from that piece to this one.
  void join(const Piece& other, const Pose2& T_this_other);

 private:
  // Where a session begins.
  struct Begin {
    std::size_t keyframe = 0, scan = 0;
  };

  void add(Keyframe keyframe, const std::optional<Pose2>& T_odom_base);
  Keyframe add_to_map(Keyframe keyframe);

  MapBuilder builder_;
  KeyframeSpool* const spool_;  // nothing where others keep the keyframes
  const Keep keep_;
  matching::Localiser localiser_;
  std::vector<StampedPose3> trajectory_;
  std::vector<SpooledKeyframe> keyframes_;
  Begin second_session_;
};

}  // namespace voxlist::mapping
