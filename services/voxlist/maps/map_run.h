#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "services/voxlist/maps/summary.h"
#include "services/voxlist/recording/scan_input.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::desk {

/// Localiser and mapper in one: places scans one after the other and grows the map from them.
/// Equal scans give an equal map.
class MapRun {
 public:
  /// Is given each keyframe that went into the map.
  using Keep = std::function<void(const mapping::Keyframe&)>;

  /// Goes on with a map that is there, or an empty one.
  MapRun(const matching::LocaliserConfig& localiser, mapping::MapBuilder map, Keep keep)
      : empty_(map.poses().empty() ? std::optional(map) : std::nullopt),
        builder_(std::move(map)),
        keep_(std::move(keep)),
        localiser_(builder_->map(), localiser) {}

  /// Finds the scan's pose, and adds the scan to the map if it is sure and the scan tells
  /// something new. As long as a map is one scan that no other fits, the next scan begins it anew:
  /// one of the two is bad, and it may be the first.
  void localise(Scan scan);

  /// Adds the scan to the map at a pose that is known.
  void place(Scan scan, const Pose3& T_map_base);

  /// No scan comes any more.
  void finish();

  const mapping::MapBuilder& builder() const { return *builder_; }

  /// T_map_base of every scan that was placed.
  const std::vector<StampedPose3>& trajectory() const { return trajectory_; }

  /// What became of the scans so far, and of no more than that.
  RunFigures figures() const;

 private:
  void add(mapping::Keyframe keyframe);
  void begin_anew();
  void note(const Scan& scan);
  void note_lost(const Scan& scan, matching::LocalisationState state);

  const std::optional<mapping::MapBuilder> empty_;
  std::optional<mapping::MapBuilder> builder_;
  // The map's first keyframe, until a second scan fits it.
  std::optional<mapping::Keyframe> unconfirmed_;
  const Keep keep_;
  matching::Localiser localiser_;
  std::vector<StampedPose3> trajectory_;
  std::int64_t lost_ = 0, ambiguous_ = 0;
  std::optional<std::int64_t> first_us_;
  std::optional<LostScan> first_lost_;
  bool odometry_ = false;
};

}  // namespace voxlist::desk
