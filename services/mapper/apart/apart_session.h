#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>

#include "services/mapper/apart/apart_file.h"
#include "voxlist/geometry/cloud.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/mapping/pieces/piece.h"
#include "voxlist/mapping/pieces/piece_joint.h"
#include "voxlist/matching/localisation/leaving.h"

namespace voxlist::bus {
class Health;
}

namespace voxlist::services {

/// Where the robot has left the map, mapping goes on apart: in a piece with a frame of its own,
/// which is tracked here, until clouds that fit both say surely where it lies in the map. Then its
/// keyframes get their place there. A session on a saved map is apart until it is found. What never
/// joins is in recordings beside the map.
class ApartSession {
 public:
  /// A session on the map of this folder; nothing is kept apart without one (empty). `is_saved`:
  /// the map was there before. `localiser` tracks the pieces. A piece that an earlier mapper left
  /// in the middle of a drive is taken up.
  ApartSession(bus::Health& health, const std::filesystem::path& folder, bool is_saved,
               const matching::LocaliserConfig& localiser,
               const mapping::MapBuilderConfig& builder);
  ~ApartSession();

  /// A cloud has no place in the map, which says this of it.
  void lost(const Cloud& cloud, const std::optional<Pose2>& T_odom_base,
            const matching::Localisation& in_map);

  /// A cloud was found in the map.
  void found(const Cloud& cloud, const std::optional<Pose2>& T_odom_base,
             const matching::Localisation& in_map);

  /// Hands out the newest keyframe of a piece that was joined, to be added to the map before the
  /// next.
  std::optional<ApartCloud> place_next();

  /// The map was moved under the robot. `T_new_old`: from the map before to the map since.
  void move(const Pose2& T_new_old);

 private:
  void take_up(const std::filesystem::path& left);
  bool has_left_map(const matching::ScanMoment& now, const matching::Localisation& in_map) const;
  void go_on(const Cloud& cloud, const matching::ScanMoment& now);
  matching::Localisation look(const Cloud& cloud, const matching::ScanMoment& now);
  void begin(const Cloud& cloud, const matching::ScanMoment& now);
  void take(const Cloud& cloud, const matching::Localisation& found,
            const matching::ScanMoment& now);
  void keep(ApartCloud keyframe);
  bool is_left_by(const matching::ScanMoment& now, const matching::Localisation& found) const;
  void join(const Pose2& T_map_piece);
  void leave();
  void end_piece();
  void tell() const;

  bus::Health& health_;
  const matching::LocaliserConfig localiser_;
  const mapping::MapBuilderConfig builder_;
  const bool is_saved_;
  ApartFile file_;
  // The last cloud that was found in the map, and how many were since this session began.
  matching::ScanMoment in_map_;
  std::int64_t found_ = 0;
  // The piece that the robot is in, its keyframes, the oldest first, and its last cloud that fit.
  std::unique_ptr<mapping::Piece> piece_;
  std::deque<ApartCloud> kept_;
  std::size_t bytes_ = 0;
  std::optional<matching::ScanMoment> in_piece_;
  // What clouds say that fit map and piece, and where in the piece the last of them was taken.
  mapping::PieceJoint joint_;
  std::optional<Pose2> asked_at_;
  // Keyframes of a piece that has its place, where they are in the map, the oldest first.
  std::deque<ApartCloud> joining_;
};

}  // namespace voxlist::services
