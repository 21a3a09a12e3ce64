#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "voxlist/mapping/map_store.h"

namespace voxlist::mapping {

/// Name of the file in a map folder that has the map as it was built.
inline constexpr const char* kBuiltFile = "built.voxlist";

/// What a map is built of.
struct BuiltOf {
  std::int64_t map_id = 0;
  /// Keyframes in their file, and where each of them stands.
  std::span<const KeyframePlace> places;
  std::span<const StampedPose3> poses;

  /// A number of the first so many that other keyframes, poses, settings or programs do not give.
  std::uint64_t key(std::size_t keyframes, const MapBuilderConfig& config) const;
};

/// Writes a builder's map, without edits, into its folder. Precondition: it is built of all of
/// them. Throws FileError; then the old file is there.
void write_built(const std::filesystem::path& folder, const BuiltOf& of, const MapBuilder& builder);

/// Reads it into an empty builder, if it is built of the first of these keyframes. Returns how many
/// these are: they are in the map. 0: there is no such file, or it is of no use.
std::size_t read_built(const std::filesystem::path& folder, const BuiltOf& of, MapBuilder& builder);

/// Puts the keyframes that it does not have yet into a builder, in their order, each where it
/// stands. `poses`: of all keyframes. `at_each` is called before each. Of one that the disk has
/// lost only the pose is there. Throws FileError when the disk cannot be read.
void add_stored(StoredKeyframes& keyframes, std::span<const StampedPose3> poses,
                MapBuilder& builder, const std::function<void()>& at_each);

}  // namespace voxlist::mapping
