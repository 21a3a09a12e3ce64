#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "voxlist/mapping/keyframe_writer.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/system/file_lock.h"

namespace voxlist::mapping {

/// Name of the keyframe file in a map folder.
inline constexpr const char* kKeyframeFile = "keyframes.voxlist";

/// Name of the file in a map folder whose lock the mapper holds that adds to the map.
inline constexpr const char* kMapLock = "mapper.lock";

/// Throws FileError, which names the process, when a mapper works in the folder now.
void refuse_folder_in_use(const std::filesystem::path& folder);

/// Takes the lock of a map folder, as the mapper does. Throws FileError when somebody else has it,
/// or it cannot be written.
FileLock lock_folder(const std::filesystem::path& folder);

/// Writes a folder's keyframe file anew, in place of one that is there, all or nothing. Throws
/// FileError.
void write_keyframes(const std::filesystem::path& folder, std::int64_t map_id,
                     const std::vector<Keyframe>& keyframes);

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

  /// As KeyframeWriter::append.
  void append(const Keyframe& keyframe) { writer_->append(keyframe); }

  /// False when the folder or its file was removed, replaced or cut under us.
  bool is_in_place() const { return writer_->is_in_place(); }

 private:
  std::filesystem::path file() const { return folder_ / kKeyframeFile; }
  void read(std::int64_t new_map_id, const Take& take);
  void mend();

  std::filesystem::path folder_;
  FileLock lock_;
  std::int64_t map_id_ = 0;
  std::string notice_;
  std::unique_ptr<KeyframeWriter> writer_;
};

}  // namespace voxlist::mapping
