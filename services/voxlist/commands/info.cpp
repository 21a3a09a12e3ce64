#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/maps/stored_map.h"
#include "services/voxlist/maps/summary.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::desk {
namespace {

struct InfoOptions {
  std::filesystem::path folder;
  bool json = false;
};

// What a map folder's keyframe file tells.
class MapInfo {
 public:
  MapInfo(const std::filesystem::path& folder, Console& console)
      : reader_(folder / mapping::kKeyframeFile) {
    while (!stop_requested()) {
      auto keyframe = reader_.next();
      if (!keyframe) break;
      add(std::move(*keyframe));
    }
    mapping::MapEdits edits = edits_of(folder, console);
    edits_ = edits.edits.size();
    builder_.edit(std::move(edits));
  }

  nlohmann::ordered_json json() const {
    const VoxelMap& map = builder_.map().occupied;
    const auto keyframes = builder_.poses().size();
    return {
        {"map_id", reader_.map_id().value_or(0)},
        {"keyframes", keyframes},
        {"left_out",
         reader_.next_number() - std::min<std::size_t>(reader_.next_number(), keyframes)},
        {"points", points_},
        {"voxels", map.size()},
        {"resolution_m", map.resolution_m()},
        {"map_hash", hash_text(map)},
        {"edits", edits_},
        {"way_m", way_m_},
        {"first_utime", keyframes > 0 ? builder_.poses().front().utime_us : 0},
        {"last_utime", keyframes > 0 ? builder_.poses().back().utime_us : 0},
    };
  }

  std::string warning() const { return reader_.warning(); }

 private:
  void add(mapping::Keyframe keyframe) {
    points_ += keyframe.cloud.points.size();
    if (!builder_.poses().empty()) {
      const Pose3& last = builder_.poses().back().pose;
      way_m_ += (keyframe.T_map_base.translation() - last.translation()).norm();
    }
    builder_.add(std::move(keyframe));
  }

  mapping::KeyframeReader reader_;
  mapping::MapBuilder builder_;
  std::size_t points_ = 0, edits_ = 0;
  double way_m_ = 0.0;
};

int info(const InfoOptions& options, Console& console) {
  const MapInfo map(options.folder, console);
  if (stop_requested()) {
    console.warn("interrupted: the map was not read to its end");
    return kInterrupted;
  }
  if (!map.warning().empty()) console.warn(map.warning());
  const nlohmann::ordered_json json = map.json();
  if (options.json) {
    console.say(json.dump(2));
  } else {
    for (const auto& [key, value] : json.items())
      console.say(fmt::format("{:14} {}", key,
                              value.is_string() ? value.get<std::string>() : value.dump()));
  }
  return 0;
}

}  // namespace

void add_info(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand("info", "Tells what a map folder holds.");
  const auto options = std::make_shared<InfoOptions>();
  command->add_option("MAPDIR", options->folder, "map folder, as voxlist map or the mapper made it")
      ->required();
  command->add_flag("--json", options->json, "as JSON");
  command->footer(
      "Example:\n"
      "  voxlist info hall_map --json");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return info(*options, console); };
  });
}

}  // namespace voxlist::desk
