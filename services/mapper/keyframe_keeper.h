#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "voxlist/mapping/built/built_map.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::bus {
class Health;
}

namespace voxlist::services {

/// The keyframes of the mapper's map: on the disk, and in memory only those that the disk does not
/// take, up to kMostWaiting. Each goes to the disk at once. How that goes is told in HEALTH. A
/// folder that vanishes costs nothing: the map goes on in a fresh one beside it.
class KeyframeKeeper {
 public:
  /// Most bytes that wait in memory for a disk, or are all there is without a folder: some 900
  /// clouds of 12,000 points.
  static constexpr std::size_t kMostWaiting = 256'000'000;

  /// Reads the folder's map into `builder`. Without a folder (empty) there is none; `extend` false:
  /// nothing is ever written. Throws FileError as MapStore and KeyframeReader do, and Stopped.
  KeyframeKeeper(bus::Health& health, const std::filesystem::path& folder, bool extend,
                 std::int64_t new_map_id, mapping::MapBuilder& builder);

  std::int64_t map_id() const { return map_id_; }

  /// Where the map is written; empty when it is not.
  std::filesystem::path folder() const { return store_ ? store_->folder() : ""; }

  std::size_t size() const { return on_disk() + waiting_.size(); }

  /// About what a keyframe takes in memory.
  std::size_t bytes(std::size_t index) const;

  /// A keyframe; its pose alone, and an error in HEALTH, when the disk has lost it.
  mapping::Keyframe read(std::size_t index);

  /// The keyframes once more, for another thread; nothing where not all are on the disk.
  std::unique_ptr<mapping::StoredKeyframes> open_again() const;

  /// Writes where the keyframes stand now. False, and an error in HEALTH, when the disk does not
  /// take it: then they stand where they stood.
  bool write_graph(const mapping::StoredGraph& graph);

  /// The map's boxes that were edited by hand.
  const mapping::MapEdits& edits() const { return edits_; }

  /// Takes other edits, on the disk first. Returns why it does not, for people; empty: it does.
  std::string write_edits(mapping::MapEdits edits);

  /// How often the folder's keyframes were moved before.
  std::int64_t moves() const { return moves_; }

  /// Whether one more may be added: false once too many wait for the disk.
  bool has_room() const { return waiting_bytes_ < kMostWaiting; }

  void add(mapping::Keyframe keyframe);

  /// Gives all keyframes up for an empty map of that id; their file is kept aside. False, and an
  /// error in HEALTH, when the disk does not let it: then nothing has changed.
  bool begin_anew(std::int64_t new_map_id);

  /// Writes some of what waits, and looks whether the folder is still there. Call it twice a
  /// second.
  void look_after();

  /// Keeps the map as it is built beside the keyframes, so that the next start need not build it
  /// again. Does nothing where it is there already, or some of them wait for the disk. Throws
  /// FileError.
  void write_built();

  /// Writes all that waits. False when the disk does not take it.
  bool finish();

 private:
  void open_store();
  void open_read_only();
  void build(const std::vector<StampedPose3>& poses);
  mapping::BuiltOf built_of() const;
  mapping::StoredKeyframes* disk() const { return store_ ? &store_->keyframes() : served_.get(); }
  std::size_t on_disk() const { return disk() ? disk()->size() : 0; }
  mapping::Keyframe read_from_disk(std::size_t index);
  void write_waiting(std::size_t at_most);
  void tell_room();
  void move_to_fresh_folder();
  void copy_to(const std::filesystem::path& folder);
  void fail(const std::string& what, const std::string& sentence);

  bus::Health& health_;
  const std::filesystem::path folder_;
  mapping::MapBuilder& builder_;
  std::int64_t map_id_;
  std::int64_t moves_ = 0;
  std::uint64_t kept_key_ = 0;  // of the built map on the disk
  mapping::MapEdits edits_;
  std::unique_ptr<mapping::MapStore> store_;          // of a map that is written
  std::unique_ptr<mapping::StoredKeyframes> served_;  // of one that is not
  std::deque<mapping::Keyframe> waiting_;             // after those on the disk
  std::size_t waiting_bytes_ = 0;
};

}  // namespace voxlist::services
