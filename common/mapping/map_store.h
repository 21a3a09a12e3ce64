#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "voxlist/mapping/edits/map_edits.h"
#include "voxlist/mapping/keyframe_writer.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/system/file_lock.h"

namespace voxlist::mapping {

/// Name of the keyframe file in a map folder.
inline constexpr const char* kKeyframeFile = "keyframes.voxlist";

/// Name of the file in a map folder whose lock the mapper holds that adds to the map.
inline constexpr const char* kMapLock = "mapper.lock";

/// Takes the lock of a map folder, as the mapper does. Throws FileError when another process has
/// it, which it names, or when it cannot be written.
FileLock lock_folder(const std::filesystem::path& folder);

/// The keyframes of a file, by their index: on the disk, one at a time in memory. They can be read
/// even after the file was removed.
class StoredKeyframes {
 public:
  StoredKeyframes(const std::filesystem::path& file, std::vector<KeyframePlace> places)
      : reader_(file), places_(std::move(places)) {}

  std::size_t size() const { return places_.size(); }

  /// Bytes of a keyframe in the file.
  std::uint64_t bytes(std::size_t index) const { return places_[index].bytes; }

  /// A keyframe as it was when it came; nothing when its record was damaged or cut off meanwhile.
  /// Throws FileError when the disk cannot be read.
  std::optional<Keyframe> read(std::size_t index) { return reader_.at(places_[index]); }

  /// Where each of them lies in the file.
  const std::vector<KeyframePlace>& places() const { return places_; }

  /// One more was appended to the file.
  void add(const KeyframePlace& place) { places_.push_back(place); }

 private:
  KeyframeReader reader_;
  std::vector<KeyframePlace> places_;
};

/// A map folder that keyframes are added to: its lock, and its keyframe file. Nothing that was in
/// the file is ever lost: a damaged file is kept aside under a name of its own
/// (keyframes.voxlist.damaged, .damaged-1, ...).
class MapStore {
 public:
  using Take = std::function<void(Keyframe)>;

  /// Makes the folder if need be, takes its lock, and hands each whole keyframe to `take`. A new
  /// map gets `new_map_id`. Throws FileError when another mapper has the folder, when the file is
  /// none of Voxlist, and when the disk cannot be read or written.
  MapStore(const std::filesystem::path& folder, std::int64_t new_map_id, const Take& take);

  std::int64_t map_id() const { return map_id_; }
  const std::filesystem::path& folder() const { return folder_; }

  /// What was damaged and what became of it, one line for the log; empty when all was whole.
  const std::string& notice() const { return notice_; }

  /// Begins an empty map of that id, without edits. The files of the one before are kept aside
  /// (keyframes.voxlist.given-up, .given-up-1, ...), unless it is empty. Throws FileError; then the
  /// map is as it was.
  void begin_anew(std::int64_t new_map_id);

  /// As KeyframeWriter::append.
  void append(const Keyframe& keyframe) { keyframes_->add(writer_->append(keyframe)); }

  /// Where the keyframes stand that are there now: this graph replaces the one that is there.
  /// Throws FileError. What is appended from now on stands where it says.
  void write_graph(const StoredGraph& graph);

  /// How often they were moved so far.
  std::int64_t moves() const { return moves_; }

  /// Boxes that were edited by hand.
  const MapEdits& edits() const { return edits_; }

  /// These edits replace those that are there. Throws FileError; then those are still there.
  void write_edits(MapEdits edits);

  /// What is on the disk.
  StoredKeyframes& keyframes() { return *keyframes_; }

  /// False when the folder or its file was removed, replaced or cut under us.
  bool is_in_place() const { return writer_->is_in_place(); }

 private:
  std::filesystem::path file() const { return folder_ / kKeyframeFile; }
  void read(std::int64_t new_map_id, const Take& take);
  void mend(std::vector<KeyframePlace>& places);
  void read_edits();

  std::filesystem::path folder_;
  FileLock lock_;
  std::int64_t map_id_ = 0;
  std::string notice_;
  std::int64_t moves_ = 0;
  MapEdits edits_;
  std::unique_ptr<KeyframeWriter> writer_;
  std::unique_ptr<StoredKeyframes> keyframes_;
};

}  // namespace voxlist::mapping
