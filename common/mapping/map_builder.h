#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/geometry/tilt.h"
#include "voxlist/mapping/edits/map_edits.h"
#include "voxlist/voxels/edits/edited_map.h"
#include "voxlist/voxels/voids/carved_map.h"

namespace voxlist::mapping {

/// A cloud with its place in the map: what maps are made of.
struct Keyframe {
  Pose3 T_map_base = Pose3::Identity();
  /// The points, in base.
  Cloud cloud;
};

struct MapBuilderConfig {
  /// A cloud is looked at after this much motion since the last one that was (m, or degrees)...
  double min_distance_m = 0.3;
  double min_turn_deg = 12.0;
  /// ...and added when it tells this share of news (ScanNews::share). So a map ends growing where
  /// all is known: laps through six rooms made 141 keyframes in the first, 1 in five more, where
  /// motion alone makes 334 in each. At 0.05 new ground is mapped as with 0 (the hall's map is the
  /// same bit for bit); at 0.1 a fifth of its keyframes is left out.
  double min_news = 0.05;
  /// Points farther from the sensor than this are left out (m).
  double max_range_m = 100.0;
  /// Points nearer than this are no points (m): a window, a drop, or 0,0,0 for "nothing came back".
  double min_range_m = 0.05;
  /// Whether what has gone leaves the map: people who walked by, furniture that was moved
  /// (CarvedMap). It costs about 3 ms a keyframe, and some of what is thin: up to a tenth of table
  /// tops and poles (tests/bench). False: what was hit once stays for good.
  bool carve = false;
  /// Whether free space is counted beside the map, for planners (FreeSpace). No setting: it is for
  /// who sends it on.
  bool count_free = false;

  template <class Visitor>
  void visit(Visitor& v) {
    v("min_distance_m", min_distance_m, "motion after which a cloud is looked at for news", 0.0,
      100.0);
    v("min_turn_deg", min_turn_deg, "turn after which a cloud is looked at for news", 0.0, 180.0);
    v("min_news", min_news,
      "share of a cloud's cells that are news to the map, which makes it worth adding; 0: any", 0.0,
      1.0);
    v("max_range_m", max_range_m, "points farther away than this stay out of the map", 0.5, 1000.0);
    v("min_range_m", min_range_m, "points nearer than this are no points, nor is 0,0,0", 0.0, 10.0);
    v("carve", carve,
      "what has gone leaves the map: people who walked by, moved furniture, and some of what is "
      "thin; false: it stays");
  }
};

/// Builds the map of what is occupied and what rays passed from clouds whose pose is known.
/// Keyframes are the truth, the map is a view of them. Their points are not kept here.
class MapBuilder {
 public:
  explicit MapBuilder(const MapBuilderConfig& config = {});

  const MapBuilderConfig& config() const { return config_; }

  /// Whether a cloud (in base) at this pose (T_map_base, which must be a sure one) is worth adding:
  /// it has moved enough since the last one that was looked at, and tells enough that is new.
  bool wants(const Cloud& cloud, const Pose2& pose, const Tilt& tilt = {});

  /// Puts a keyframe into the map, whatever wants() says; without its points nearer than
  /// min_range_m. Returns it as it is in the map, for whoever keeps it: here only its pose is.
  Keyframe add(Keyframe keyframe);

  /// Hands out the cloud of a keyframe, as add() returned it, by its number.
  using ReadCloud = std::function<Cloud(std::size_t)>;

  /// Moves keyframes, or takes them out. `poses`: where each of those in the map belongs now;
  /// nothing: it is taken out. The map then has the same bits as one made anew of them in their
  /// order. Where fewer than half of them move, only what these see is made again, from all that
  /// reach it.
  void move(const std::vector<std::optional<Pose3>>& poses, const ReadCloud& read);

  /// Takes the map of another builder, whose keyframes are the same and stand elsewhere; then
  /// what changed is what is otherwise. `T_new_old`: how the newest one was moved.
  void move_to(MapBuilder moved, const Pose2& T_new_old);

  /// Takes edits by hand in the place of those before. They come last in the map and in free
  /// space, whatever is added or moved afterwards.
  void edit(MapEdits edits);

  const MapEdits& edits() const { return edits_; }

  /// Calls visit(part) for each VoxelMap and CounterMap that the map is made of, without edits.
  template <class Visit>
  void visit_built(const Visit& visit) const {
    std::as_const(*map_).visit_parts(visit);
  }

  /// An empty builder has that map again: fill(part) fills the same parts, and keyframes stand at
  /// these poses.
  template <class Fill>
  void restore(std::vector<StampedPose3> poses, const Fill& fill) {
    map_->restore(fill);
    poses_ = std::move(poses);
    if (!poses_.empty()) looked_at_ = to_pose2(poses_.back().pose);
  }

  /// Begins an empty map, without edits.
  void clear();

  const OccupancyMap& map() const { return edited_map_.of(map_->map()); }

  /// When and where each keyframe was taken, in their order.
  const std::vector<StampedPose3>& poses() const { return poses_; }

  /// What the last add(), move(), move_to() or edit() changed. Where move() made all anew, the
  /// revisions tell that more has changed than the blocks do.
  const ChangedBlocks& changed_blocks() const { return changed_blocks_; }

  /// Free and occupied cells as counted; empty unless count_free.
  const OccupancyMap& free_space() const { return edited_free_.of(map_->free_space().map()); }

  /// What the same changed there.
  const ChangedBlocks& changed_free_space() const { return changed_free_space_; }

 private:
  bool has_moved(const Pose2& pose) const;
  double news_of(const CarvedMap::Scan& scan);
  void place_edits();
  void make_anew(const std::vector<std::optional<Pose3>>& poses, const ReadCloud& read);
  void recount(const std::vector<std::optional<Pose3>>& poses, const ReadCloud& read);

  const MapBuilderConfig config_;
  std::unique_ptr<CarvedMap> map_;
  std::vector<StampedPose3> poses_;
  MapEdits edits_;
  EditedMap edited_map_{EditUse::kMatching}, edited_free_{EditUse::kPlanning};
  ChangedBlocks changed_blocks_, changed_free_space_;
  Pose2 looked_at_;  // where the last cloud was added or looked at
};

}  // namespace voxlist::mapping
