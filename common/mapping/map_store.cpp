#include "voxlist/mapping/map_store.h"

#include <fmt/core.h>

#include <optional>
#include <stdexcept>
#include <utility>

#include "voxlist/io/files/file.h"
#include "voxlist/io/files/keep_aside.h"
#include "voxlist/mapping/edits/stored_edits.h"
#include "voxlist/mapping/graph/stored_graph.h"
#include "voxlist/mapping/keyframe_reader.h"

namespace voxlist::mapping {
namespace {

namespace fs = std::filesystem;

fs::path made(fs::path folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw io::FileError(folder, "cannot create the map folder: " + error.message());
  return folder;
}

[[noreturn]] void refuse(const fs::path& folder) {
  throw io::FileError(
      folder, fmt::format("process {} works in this map folder; stop it, or choose another folder",
                          lock_owner(folder / kMapLock)));
}

}  // namespace

FileLock lock_folder(const fs::path& folder) try {
  auto lock = FileLock::take(folder / kMapLock);
  if (!lock) refuse(folder);
  return std::move(*lock);
} catch (const io::FileError&) {
  throw;
} catch (const std::runtime_error& error) {
  throw io::FileError(folder, fmt::format("cannot be locked ({}); to serve a map that may not be "
                                          "changed, set extend = false",
                                          error.what()));
}

MapStore::MapStore(const fs::path& folder, std::int64_t new_map_id, const Take& take)
    : folder_(made(folder)), lock_(lock_folder(folder_)) {
  io::remove_stale_temporaries(folder_);
  if (!fs::exists(file())) NewKeyframeFile(file(), new_map_id).commit();
  read(new_map_id, take);
}

void MapStore::read(std::int64_t new_map_id, const Take& take) {
  KeyframeReader reader(file());
  std::vector<KeyframePlace> places;
  while (auto keyframe = reader.next()) {
    places.push_back(reader.place());
    take(std::move(*keyframe));
  }
  map_id_ = reader.map_id().value_or(new_map_id);
  moves_ = reader.moves();
  notice_ = reader.warning();
  if (reader.is_damaged()) mend(places);
  writer_ = std::make_unique<KeyframeWriter>(file(), map_id_, reader.next_number());
  keyframes_ = std::make_unique<StoredKeyframes>(file(), std::move(places));
  read_edits();
}

void MapStore::read_edits() {
  FoundEdits found = find_edits(folder_, map_id_);
  edits_ = std::move(found.edits);
  if (!notice_.empty() && !found.fault.empty()) notice_ += "; ";
  notice_ += found.fault;
}

void MapStore::write_edits(MapEdits edits) {
  mapping::write_edits(folder_, edits);
  edits_ = std::move(edits);
}

// One that is not this map's may be somebody's.
void MapStore::write_graph(const StoredGraph& graph) {
  if (!find_graph(folder_, map_id_).fault.empty()) io::keep_aside(folder_ / kGraphFile, ".damaged");
  mapping::write_graph(folder_, graph);
  if (graph.moves == std::exchange(moves_, graph.moves)) return;
  writer_->append_moved(graph.moves);
}

void MapStore::begin_anew(std::int64_t new_map_id) {
  NewKeyframeFile empty(file(), new_map_id);
  if (keyframes_->size() > 0) io::keep_aside(file(), ".given-up");
  empty.commit();
  remove_graph(folder_);
  give_up_edits(folder_);
  read(new_map_id, [](const Keyframe&) {});
}

// A file that cannot be written anew, for want of room, stays: the reader steps over its damage.
void MapStore::mend(std::vector<KeyframePlace>& places) try {
  KeyframeReader reader(file());
  NewKeyframeFile whole(file(), map_id_);
  std::vector<KeyframePlace> new_places;
  while (const auto keyframe = reader.next()) new_places.push_back(whole.add(*keyframe));
  const fs::path aside = io::keep_aside(file(), ".damaged");
  whole.commit();
  places = std::move(new_places);
  notice_ += fmt::format("; the damaged file is kept as {}", aside.filename().string());
} catch (const io::FileError& error) {
  notice_ += fmt::format("; it stays in use, because {}", error.what());
}

}  // namespace voxlist::mapping
