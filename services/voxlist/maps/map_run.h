#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "services/voxlist/maps/ahead/look_ahead.h"
#include "services/voxlist/maps/odometry_trail.h"
#include "services/voxlist/maps/piece_closing.h"
#include "services/voxlist/maps/scan_log.h"
#include "services/voxlist/maps/summary.h"
#include "services/voxlist/recording/scan_input.h"
#include "voxlist/mapping/keyframe_spool.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/mapping/pieces/piece.h"
#include "voxlist/mapping/pieces/piece_joint.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::desk {

/// Localiser and mapper in one: places scans one after the other and grows the map from them.
/// Where a scan fits nowhere, mapping goes on with that scan as the origin of a new piece beside
/// the old one. A scan that surely fits two pieces makes them one: the smaller goes into the
/// larger. At the end the largest piece is the map; the others carry no pose in it. Equal scans
/// give an equal map.
class MapRun {
 public:
  /// Begins a map. The spool must outlive this.
  MapRun(const matching::LocaliserConfig& localiser, const mapping::MapBuilderConfig& mapper,
         mapping::KeyframeSpool& spool);

  /// Goes on with a map that is there: it is the map whatever comes beside it, and `keep` is given
  /// each keyframe that goes into it.
  MapRun(const matching::LocaliserConfig& localiser, const mapping::MapBuilderConfig& mapper,
         mapping::KeyframeSpool& spool, mapping::MapBuilder map, mapping::Piece::Keep keep);

  /// Finds the scan's pose, and adds the scan to the map if it is sure and the scan tells
  /// something new.
  void localise(const Scan& scan);

  /// Adds the scan to the map at a pose that is known.
  void place(Scan scan, const Pose3& T_map_base);

  /// No scan comes any more: what has no place yet is searched for in the map as it has grown, and
  /// the map's loops are closed, but not those of a map that was there.
  void finish();

  const mapping::MapBuilder& builder() const { return map().builder(); }

  /// T_map_base of every scan that was placed, in the order of time.
  std::vector<StampedPose3> trajectory() const;

  /// The map's keyframes in the spool; none of a map that was there.
  const std::vector<mapping::SpooledKeyframe>& keyframes() const { return map().keyframes(); }

  /// The loops that finish() closed.
  const drawing::ClosedLoops& closed_loops() const { return closing_.drawn; }

  /// Where the map's keyframes stand and what holds them; none where finish() closed no loops.
  const mapping::StoredGraph& graph() const { return closing_.graph; }

  /// What was said of each scan that was localised, in their order.
  const std::vector<ScanRow>& scan_log() const { return scan_log_; }

  /// What became of the scans, and no more than that.
  RunFigures figures() const;

 private:
  // The piece that a new one was begun beside, whose last scan may yet fit that one: where it said
  // that the newest piece's origin may be, how often that was tried, and what the last try that was
  // sure said.
  struct Behind {
    mapping::Piece* piece;
    Pose2 T_behind_now;
    int looks = 0;
    std::optional<Pose2> T_look = std::nullopt;
  };

  const mapping::Piece& map() const;
  mapping::Piece& map() { return const_cast<mapping::Piece&>(std::as_const(*this).map()); }
  bool is_confirmed(const mapping::Piece& piece) const;
  mapping::Piece& new_piece();
  void erase(const mapping::Piece& piece);

  void note(const Scan& scan);
  void note_lost(const Scan& scan, matching::LocalisationState state);
  std::int64_t count_ambiguous() const;

  // What was said of a scan, after all that follows from it was done.
  struct Said {
    matching::LocalisationState state;
    double probability;
  };
  Said look_at(const Scan& scan);

  std::optional<Said> go_back(const Scan& scan);
  bool is_near(const Scan& scan, const matching::Localisation& found) const;
  void wait(const Scan& scan);
  void begin_piece(const Scan& scan, const matching::Localisation& elsewhere);
  void take(const Scan& scan, const matching::Localisation& found);
  void loosen(mapping::Piece& piece);

  void search_elsewhere(const Scan& scan);
  void look_back();
  void join(mapping::Piece& piece, mapping::Piece& other, const Pose2& T_piece_other);

  bool join_one();
  bool joins(mapping::Piece& larger, mapping::Piece& smaller);
  void place_loose();
  bool place_between(const Cloud& cloud, const std::optional<Pose2>& T_odom_base);
  bool place_anywhere(const Cloud& cloud, const std::optional<Pose2>& T_odom_base);

  const matching::LocaliserConfig localiser_;
  const mapping::MapBuilderConfig mapper_;
  mapping::KeyframeSpool& spool_;
  const bool goes_on_;
  LookAhead look_ahead_;
  std::vector<std::unique_ptr<mapping::Piece>> pieces_;
  // The piece that mapping goes on in.
  mapping::Piece* now_ = nullptr;
  // The one before it, as long as the newest has but one scan, which may be the bad one.
  mapping::Piece* left_ = nullptr;
  // Odometry where the last scan was placed.
  std::optional<Pose2> T_odom_placed_;
  std::optional<Behind> behind_;
  mapping::PieceJoint joint_;
  std::size_t searches_ = 0;
  // Scans that belong to no piece: only scans of pieces that no other fitted.
  std::vector<mapping::SpooledKeyframe> loose_;
  PieceClosing closing_;
  std::int64_t scans_ = 0;
  std::vector<ScanRow> scan_log_;
  // Times of scans that were AMBIGUOUS when they came.
  std::vector<std::int64_t> ambiguous_us_;
  std::optional<std::int64_t> first_us_;
  std::optional<LostScan> first_lost_;
  bool odometry_ = false;
  OdometryTrail odometry_trail_;
  std::optional<matching::OdometryBias> odometry_bias_;
  std::optional<matching::Floor> floor_;
};

}  // namespace voxlist::desk
