#include "services/mapper/keyframe_keeper.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "voxlist/bus/health.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/files/keep_aside.h"
#include "voxlist/mapping/edits/stored_edits.h"
#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/keyframe_writer.h"
#include "voxlist/service/stop.h"

namespace voxlist::services {
namespace {

using State = bus::Health::State;

// Keyframes that are written at once, of those that wait for a disk that works again: each takes it
// 5 ms, and nothing else is done meanwhile.
constexpr std::size_t kWrittenAtOnce = 50;

// A map that took so many keyframes to be built is kept as it is then: about a second of work.
constexpr std::size_t kWorthKeeping = 200;

// Of a keyframe without points.
constexpr std::size_t kFixedBytes = 200;

std::size_t bytes_of(const mapping::Keyframe& keyframe) {
  const Cloud& cloud = keyframe.cloud;
  return kFixedBytes + (cloud.points.size() + cloud.origins.size()) * sizeof(Eigen::Vector3f);
}

// A large map takes a while to read.
void stop_if_asked() {
  if (service::stop_requested()) throw service::Stopped();
}

void note(const mapping::Keyframe& keyframe, std::vector<StampedPose3>& poses) {
  stop_if_asked();
  poses.push_back({keyframe.cloud.utime_us, keyframe.T_map_base});
}

}  // namespace

KeyframeKeeper::KeyframeKeeper(bus::Health& health, const std::filesystem::path& folder,
                               bool extend, std::int64_t new_map_id, mapping::MapBuilder& builder)
    : health_(health), folder_(folder), builder_(builder), map_id_(new_map_id) {
  if (folder_.empty()) return;
  extend ? open_store() : open_read_only();
}

void KeyframeKeeper::open_store() {
  std::vector<StampedPose3> poses;
  store_ = std::make_unique<mapping::MapStore>(
      folder_, map_id_, [&](const mapping::Keyframe& keyframe) { note(keyframe, poses); });
  map_id_ = store_->map_id();
  moves_ = store_->moves();
  edits_ = store_->edits();
  health_.raise("damage", State::kWarning, store_->notice());
  build(poses);
}

// Of the file of before, as far as it goes: the rest takes 3 to 10 ms a keyframe.
void KeyframeKeeper::build(const std::vector<StampedPose3>& poses) {
  const std::size_t built =
      mapping::read_built(folder_, {map_id_, disk()->places(), poses}, builder_);
  health_.gauge("keyframes_built_anew", static_cast<double>(poses.size() - built));
  if (built > 0) kept_key_ = built_of().key(built, builder_.config());
  mapping::add_stored(*disk(), poses, builder_, stop_if_asked);
  if (poses.size() < built + kWorthKeeping) return;
  try {
    write_built();
  } catch (const io::FileError&) {
    health_.count("save_failed");  // the next save tells why
  }
}

// Of the keyframes that are in the map.
mapping::BuiltOf KeyframeKeeper::built_of() const {
  return {map_id_, disk()->places(), builder_.poses()};
}

void KeyframeKeeper::write_built() {
  if (!store_ || !waiting_.empty()) return;
  const std::uint64_t key = built_of().key(builder_.poses().size(), builder_.config());
  if (key == kept_key_) return;
  mapping::write_built(store_->folder(), built_of(), builder_);
  kept_key_ = key;
}

void KeyframeKeeper::open_read_only() {
  const auto file = folder_ / mapping::kKeyframeFile;
  if (!std::filesystem::exists(file)) {
    return health_.raise(
        "folder", State::kWarning,
        folder_.string() + " holds no map to serve; set extend = true to make one");
  }
  mapping::KeyframeReader reader(file);
  std::vector<mapping::KeyframePlace> places;
  std::vector<StampedPose3> poses;
  while (const auto keyframe = reader.next()) {
    places.push_back(reader.place());
    note(*keyframe, poses);
  }
  map_id_ = reader.map_id().value_or(map_id_);
  moves_ = reader.moves();
  mapping::FoundEdits found = mapping::find_edits(folder_, map_id_);
  edits_ = std::move(found.edits);
  health_.raise("damage", State::kWarning, reader.warning());
  health_.raise("edits", State::kWarning, found.fault);
  served_ = std::make_unique<mapping::StoredKeyframes>(file, std::move(places));
  build(poses);
}

std::size_t KeyframeKeeper::bytes(std::size_t index) const {
  return index < on_disk() ? disk()->bytes(index) : bytes_of(waiting_[index - on_disk()]);
}

mapping::Keyframe KeyframeKeeper::read(std::size_t index) {
  mapping::Keyframe keyframe =
      index < on_disk() ? read_from_disk(index) : waiting_[index - on_disk()];
  keyframe.T_map_base = builder_.poses()[index].pose;
  return keyframe;
}

mapping::Keyframe KeyframeKeeper::read_from_disk(std::size_t index) {
  std::string why = "its record is damaged or cut off";
  try {
    if (auto keyframe = disk()->read(index)) return std::move(*keyframe);
  } catch (const io::FileError& error) {
    why = error.what();
  }
  fail("lost", fmt::format("keyframe {} cannot be read back: {}", index, why));
  mapping::Keyframe pose_alone;
  pose_alone.cloud.utime_us = builder_.poses()[index].utime_us;
  pose_alone.T_map_base = builder_.poses()[index].pose;
  return pose_alone;
}

std::unique_ptr<mapping::StoredKeyframes> KeyframeKeeper::open_again() const try {
  if (!store_ || !waiting_.empty()) return nullptr;
  return std::make_unique<mapping::StoredKeyframes>(store_->folder() / mapping::kKeyframeFile,
                                                    disk()->places());
} catch (const io::FileError&) {
  return nullptr;
}

bool KeyframeKeeper::write_graph(const mapping::StoredGraph& graph) try {
  store_->write_graph(graph);
  health_.clear("graph");
  return true;
} catch (const io::FileError& error) {
  fail("graph", error.what());
  return false;
}

std::string KeyframeKeeper::write_edits(mapping::MapEdits edits) try {
  if (store_) store_->write_edits(edits);
  edits_ = std::move(edits);
  return {};
} catch (const io::FileError& error) {
  health_.count("save_failed");
  return error.what();
}

void KeyframeKeeper::add(mapping::Keyframe keyframe) {
  waiting_bytes_ += bytes_of(keyframe);
  waiting_.push_back(std::move(keyframe));
  write_waiting(kWrittenAtOnce);
}

bool KeyframeKeeper::begin_anew(std::int64_t new_map_id) try {
  if (store_) store_->begin_anew(new_map_id);
  map_id_ = new_map_id;
  edits_ = {};
  waiting_.clear();
  waiting_bytes_ = 0;
  health_.clear("keyframes");
  return true;
} catch (const io::FileError& error) {
  fail("keyframes", error.what());
  return false;
}

void KeyframeKeeper::look_after() {
  if (!store_) return;
  store_->is_in_place() ? write_waiting(kWrittenAtOnce) : move_to_fresh_folder();
}

bool KeyframeKeeper::finish() {
  if (!store_) return true;
  write_waiting(waiting_.size());
  return waiting_.empty();
}

void KeyframeKeeper::write_waiting(std::size_t at_most) {
  tell_room();
  if (!store_) return;
  try {
    for (; at_most > 0 && !waiting_.empty(); --at_most) {
      store_->append(waiting_.front());
      waiting_bytes_ -= bytes_of(waiting_.front());
      waiting_.pop_front();
    }
    if (waiting_.empty()) health_.clear("keyframes");
  } catch (const io::FileError& error) {
    fail("keyframes", error.what());
  }
}

void KeyframeKeeper::tell_room() {
  health_.gauge("keyframes_in_memory_MB", static_cast<double>(waiting_bytes_) * 1e-6);
  if (has_room()) return health_.clear("room");
  health_.raise("room", State::kError,
                fmt::format("{} MB of clouds wait in memory for {}: the map does not grow",
                            waiting_bytes_ / 1'000'000,
                            store_ ? "the disk" : "a folder, set folder in [mapper]"));
}

void KeyframeKeeper::move_to_fresh_folder() try {
  const auto lost = store_->folder();
  const auto fresh = io::free_name(folder_, ".recovered");
  copy_to(fresh);
  store_ = std::make_unique<mapping::MapStore>(fresh, map_id_, [](const mapping::Keyframe&) {});
  waiting_.clear();
  waiting_bytes_ = 0;
  health_.clear("keyframes");
  fail("folder", fmt::format("{} was removed or replaced while the mapper ran; the map is "
                             "in {} now",
                             lost.string(), fresh.string()));
} catch (const std::exception& error) {
  fail("folder", store_->folder().string() +
                     " was removed or replaced while the mapper ran, and the map cannot be "
                     "written elsewhere: " +
                     error.what());
}

// A file that was removed can be read while it is open. Of what was cut off the poses are left.
void KeyframeKeeper::copy_to(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  mapping::NewKeyframeFile file(folder / mapping::kKeyframeFile, map_id_);
  for (std::size_t i = 0; i < size(); ++i) file.add(read(i));
  file.commit();
  if (edits_.changes > 0) mapping::write_edits(folder, edits_);
}

void KeyframeKeeper::fail(const std::string& what, const std::string& sentence) {
  health_.count("save_failed");
  health_.raise(what, State::kError, sentence);
}

}  // namespace voxlist::services
