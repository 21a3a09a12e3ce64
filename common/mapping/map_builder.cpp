#include "voxlist/mapping/map_builder.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <utility>

#include "voxlist/geometry/range.h"

namespace voxlist::mapping {
namespace {

void remove_near(Cloud& cloud, double min_range_m) {
  constexpr double kAny_m = std::numeric_limits<double>::infinity();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (!is_within(cloud, i, min_range_m, kAny_m)) continue;
    cloud.points[kept] = cloud.points[i];
    if (!cloud.origins.empty()) cloud.origins[kept] = cloud.origins[i];
    ++kept;
  }
  cloud.points.resize(kept);
  if (!cloud.origins.empty()) cloud.origins.resize(kept);
}

// A keyframe, and where it stands.
struct Place {
  std::size_t keyframe;
  const Pose3* T_map_base;
};

// Hands out the scans of places, one at a time in memory.
class Scans {
 public:
  Scans(const std::vector<Place>& places, const MapBuilder::ReadCloud& read)
      : places_(places), read_(read) {}

  std::optional<CarvedMap::Scan> operator()() {
    if (next_ == places_.size()) return std::nullopt;
    const Place& place = places_[next_++];
    cloud_ = read_(place.keyframe);
    return CarvedMap::Scan{*place.T_map_base, cloud_};
  }

 private:
  const std::vector<Place>& places_;
  const MapBuilder::ReadCloud& read_;
  std::size_t next_ = 0;
  Cloud cloud_;
};

ChangedBlocks nothing_of(const OccupancyMap& map) {
  return {{}, {}, map.revision(), map.revision()};
}

bool is_moved(const Pose3& before, const std::optional<Pose3>& now) {
  return !now || now->matrix() != before.matrix();
}

}  // namespace

MapBuilder::MapBuilder(const MapBuilderConfig& config)
    : config_(config),
      map_(std::make_unique<CarvedMap>(CarvingConfig{config.carve, config.min_range_m,
                                                     config.max_range_m, config.count_free})) {}

bool MapBuilder::has_moved(const Pose2& pose) const {
  return distance_m(pose, looked_at_) >= config_.min_distance_m ||
         turn_rad(pose, looked_at_) >= config_.min_turn_deg * std::numbers::pi / 180.0;
}

bool MapBuilder::wants(const Cloud& cloud, const Pose2& pose, const Tilt& tilt) {
  if (poses_.empty()) return true;
  if (!has_moved(pose)) return false;
  looked_at_ = pose;
  return news_of({to_pose3(pose, tilt), cloud}) >= config_.min_news;
}

// How much of a scan is news: the share of cells that it hits or passes and the map does not
// know, or that of what it sees to be gone in what it hits, whichever is larger.
double MapBuilder::news_of(const CarvedMap::Scan& scan) {
  const ScanNews news = map_->news_of(scan);
  const double doubted = static_cast<double>(map_->count_doubted(scan));
  return std::max(news.share(), doubted / static_cast<double>(std::max<std::size_t>(news.hit, 1)));
}

void MapBuilder::edit(MapEdits edits) {
  edits_ = std::move(edits);
  changed_blocks_ = nothing_of(map_->map());
  changed_free_space_ = nothing_of(map_->free_space().map());
  place_edits();
}

// Where they are now, on the map as it is now.
void MapBuilder::place_edits() {
  const std::vector<PlacedBox> boxes = edits_.placed(poses_);
  changed_blocks_ = edited_map_.take(map_->map(), boxes, changed_blocks_);
  if (!config_.count_free) return;
  changed_free_space_ = edited_free_.take(map_->free_space().map(), boxes, changed_free_space_);
}

void MapBuilder::clear() {
  map_->clear();
  edits_ = {};
  edited_map_ = EditedMap(EditUse::kMatching);
  edited_free_ = EditedMap(EditUse::kPlanning);
  poses_.clear();
  changed_blocks_ = changed_free_space_ = {};
  looked_at_ = {};
}

void MapBuilder::move(const std::vector<std::optional<Pose3>>& poses, const ReadCloud& read) {
  std::size_t moved = 0;
  for (std::size_t i = 0; i < poses_.size(); ++i) moved += is_moved(poses_[i].pose, poses[i]);
  if (moved == 0) return;
  2 * moved < poses_.size() ? recount(poses, read) : make_anew(poses, read);
  changed_free_space_ = map_->free_space().follow();
  std::vector<StampedPose3> there;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (poses[i]) there.push_back({poses_[i].utime_us, *poses[i]});
  poses_ = std::move(there);
  place_edits();
  if (!poses_.empty()) looked_at_ = to_pose2(poses_.back().pose);
}

void MapBuilder::make_anew(const std::vector<std::optional<Pose3>>& poses, const ReadCloud& read) {
  map_->clear();
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (poses[i]) changed_blocks_ = map_->add({*poses[i], read(i)});
}

void MapBuilder::recount(const std::vector<std::optional<Pose3>>& poses, const ReadCloud& read) {
  std::vector<Place> touched, all;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose3* const now = poses[i] ? &*poses[i] : nullptr;
    if (now) all.push_back({i, now});
    if (!is_moved(poses_[i].pose, poses[i])) continue;
    touched.push_back({i, &poses_[i].pose});
    if (now) touched.push_back({i, now});
  }
  changed_blocks_ = map_->recount(Scans(touched, read), Scans(all, read));
}

void MapBuilder::move_to(MapBuilder moved, const Pose2& T_new_old) {
  moved.edit(std::move(edits_));
  changed_blocks_ = difference(map(), moved.map());
  changed_free_space_ = difference(free_space(), moved.free_space());
  map_ = std::move(moved.map_);
  edits_ = std::move(moved.edits_);
  edited_map_ = std::move(moved.edited_map_);
  edited_free_ = std::move(moved.edited_free_);
  poses_ = std::move(moved.poses_);
  looked_at_ = T_new_old * looked_at_;
}

Keyframe MapBuilder::add(Keyframe keyframe) {
  // As wants() has seen it: then its rays are not followed again.
  changed_blocks_ =
      edited_map_.follow(map_->map(), map_->add({keyframe.T_map_base, keyframe.cloud}));
  changed_free_space_ = edited_free_.follow(map_->free_space().map(), map_->free_space().follow());
  remove_near(keyframe.cloud, config_.min_range_m);
  looked_at_ = to_pose2(keyframe.T_map_base);
  poses_.push_back({keyframe.cloud.utime_us, keyframe.T_map_base});
  return keyframe;
}

}  // namespace voxlist::mapping
