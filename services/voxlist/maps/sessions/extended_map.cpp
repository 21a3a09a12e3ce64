#include "services/voxlist/maps/sessions/extended_map.h"

#include <utility>

#include "voxlist/io/files/file.h"
#include "voxlist/mapping/loops/stored_looks.h"

namespace voxlist::desk {

ExtendedMap::ExtendedMap(const std::filesystem::path& folder,
                         const mapping::MapBuilderConfig& config, Console& console)
    : folder_(folder),
      config_(config),
      builder_(config),
      store_(folder, 0, [this](mapping::Keyframe keyframe) { take(std::move(keyframe)); }),
      were_there_(poses_.size()) {
  if (!store_.notice().empty()) console.warn(store_.notice());
  if (poses_.empty()) throw io::FileError(folder, "holds an empty map, make one with voxlist map");
  builder_.edit(store_.edits());
  const auto found = mapping::find_graph(folder, store_.map_id());
  if (found.graph) recall(mapping::GraphPoses(found.graph->keyframes));
}

void ExtendedMap::take(mapping::Keyframe keyframe) {
  poses_.push_back({keyframe.cloud.utime_us, keyframe.T_map_base});
  keyframes_.push_back({.utime_us = keyframe.cloud.utime_us,
                        .T_map_keyframe = to_pose2(keyframe.T_map_base),
                        .tilt = tilt_of(keyframe.T_map_base)});
  builder_.add(std::move(keyframe));
}

// What the graph of the sessions so far knows beside the poses.
void ExtendedMap::recall(mapping::GraphPoses known) {
  for (auto& keyframe : keyframes_)
    if (const auto found = known.next(keyframe.utime_us)) {
      const auto tilt = keyframe.tilt;
      keyframe = *found;
      keyframe.tilt = tilt;
    }
}

void ExtendedMap::append(const mapping::Keyframe& keyframe,
                         const std::optional<Pose2>& T_odom_base) {
  store_.append(keyframe);
  keyframes_.push_back({keyframe.cloud.utime_us, to_pose2(keyframe.T_map_base), T_odom_base,
                        keyframes_.size() == were_there_, tilt_of(keyframe.T_map_base)});
  poses_.push_back({keyframe.cloud.utime_us, keyframe.T_map_base});
}

mapping::Keyframe ExtendedMap::read(std::size_t keyframe) {
  auto found = store_.keyframes().read(keyframe);
  if (!found) throw io::FileError(folder_, "the disk lost keyframes while the map was extended");
  found->T_map_base = poses_[keyframe].pose;
  return std::move(*found);
}

mapping::SessionClosing ExtendedMap::close(const matching::MatcherConfig& config) {
  const auto level = [&](std::size_t i) { return mapping::level_cloud(read(i)); };
  mapping::LookMemory memory;
  // The mapper, too, looks by the default settings alone.
  const bool is_usual = config == matching::MatcherConfig();
  if (is_usual) mapping::read_looks(folder_, store_.map_id(), keyframes_, memory);
  mapping::SessionClosing closing = mapping::close_sessions(keyframes_, level, config, {}, &memory);
  if (is_usual) keep(memory);
  if (closing.edges.empty()) closing.edges = mapping::drive_edges(keyframes_, level, config);
  if (closing.moves) keyframes_ = mapping::moved(std::move(keyframes_), closing);
  for (std::size_t i = 0; closing.moves && i < poses_.size(); ++i)
    mapping::stand_at(keyframes_[i], poses_[i].pose);
  store_.write_graph(
      {store_.map_id(), store_.moves() + int{closing.moves}, keyframes_, closing.edges});
  return closing;
}

// They only save time, so a disk that is full costs nothing else.
void ExtendedMap::keep(const mapping::LookMemory& memory) const try {
  mapping::write_looks(folder_, store_.map_id(), keyframes_, memory);
} catch (const io::FileError&) {
}

mapping::MapBuilder ExtendedMap::rebuilt() {
  mapping::MapBuilder builder(config_);
  for (std::size_t i = 0; i < poses_.size(); ++i) builder.add(read(i));
  builder.edit(store_.edits());
  return builder;
}

}  // namespace voxlist::desk
