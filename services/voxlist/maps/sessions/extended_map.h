#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "services/voxlist/output/console.h"
#include "voxlist/mapping/loops/look_memory.h"
#include "voxlist/mapping/loops/session_closing.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::desk {

/// The map of a folder that another session is added to: each keyframe is on the disk before the
/// next one, behind those that were there.
class ExtendedMap {
 public:
  /// Reads the map; tells what is damaged. Throws FileError as MapStore does, and where the map is
  /// empty.
  ExtendedMap(const std::filesystem::path& folder, const mapping::MapBuilderConfig& config,
              Console& console);
  ExtendedMap(const ExtendedMap&) = delete;
  ExtendedMap& operator=(const ExtendedMap&) = delete;

  /// The map as it was, to go on with. Call it once.
  mapping::MapBuilder take_builder() { return std::move(builder_); }

  /// T_map_base of each keyframe: those that were there, then those that were added.
  const std::vector<StampedPose3>& poses() const { return poses_; }
  const mapping::MapKeyframes& keyframes() const { return keyframes_; }
  std::size_t were_there() const { return were_there_; }
  std::size_t added() const { return poses_.size() - were_there_; }

  /// `T_odom_base`: odometry's pose at its time, if there was odometry.
  void append(const mapping::Keyframe& keyframe, const std::optional<Pose2>& T_odom_base);

  /// Closes the loops of all sessions together, and writes where the keyframes stand. Looks that a
  /// mapper or the session before took there are not taken again. Throws FileError.
  mapping::SessionClosing close(const matching::MatcherConfig& config);

  /// Makes the map anew with its keyframes where they stand.
  mapping::MapBuilder rebuilt();

 private:
  void take(mapping::Keyframe keyframe);
  mapping::Keyframe read(std::size_t keyframe);
  void recall(mapping::GraphPoses known);
  void keep(const mapping::LookMemory& memory) const;

  const std::filesystem::path folder_;
  const mapping::MapBuilderConfig config_;
  mapping::MapBuilder builder_;
  std::vector<StampedPose3> poses_;
  mapping::MapKeyframes keyframes_;
  mapping::MapStore store_;
  std::size_t were_there_ = 0;
};

}  // namespace voxlist::desk
