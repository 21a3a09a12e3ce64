#include "services/voxlist/maps/octomap_of.h"

#include <fmt/core.h>

#include <cmath>
#include <utility>
#include <vector>

#include "services/voxlist/maps/stored_map.h"
#include "services/voxlist/output/progress.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::desk {
namespace {

// How far from its origin an OctoMap reaches: it has 2^16 voxels along each axis.
double reach_m(const planning::OctomapConfig& config) { return 32768.0 * config.resolution_m; }

bool is_beyond(const mapping::Keyframe& keyframe, const planning::OctomapConfig& config) {
  return keyframe.T_map_base.translation().cwiseAbs().maxCoeff() > reach_m(config);
}

void tell_what_lies_beyond(int beyond, const planning::OctomapConfig& config, Console& console) {
  if (beyond == 0) return;
  console.warn(
      fmt::format("{} keyframes lie beyond the {:.1f} km that map.bt reaches at {:g} m: "
                  "give a larger --octomap-resolution",
                  beyond, reach_m(config) / 1000.0, config.resolution_m));
}

void tell_if_shortened(double reach_m, Console& console) {
  if (std::isinf(reach_m)) return;
  console.warn(
      fmt::format("the OctoMap: a scan's rays pass too many voxels and free only {:.0f} m of "
                  "their way: give a larger --octomap-resolution",
                  reach_m));
}

}  // namespace

std::optional<planning::OctomapBuilder> octomap_of(const std::filesystem::path& folder,
                                                   const planning::OctomapConfig& config,
                                                   int threads, Console& console) {
  mapping::KeyframeReader keyframes(folder / mapping::kKeyframeFile);
  planning::OctomapBuilder octomap(config);
  Progress progress(console, "making the OctoMap");
  const mapping::MapEdits edits = edits_of(folder, console);
  std::vector<StampedPose3> poses;
  int beyond = 0;
  const auto next = [&]() -> std::optional<planning::PosedCloud> {
    auto keyframe = keyframes.next();
    if (!keyframe) return std::nullopt;
    beyond += is_beyond(*keyframe, config);
    poses.push_back({keyframe->cloud.utime_us, keyframe->T_map_base});
    progress.show(keyframes.progress());
    return planning::PosedCloud{keyframe->T_map_base, std::move(keyframe->cloud)};
  };
  const bool whole = octomap.insert_all(next, threads, stop_requested);
  tell_what_lies_beyond(beyond, config, console);
  tell_if_shortened(octomap.reach_m(), console);
  if (!whole || stop_requested()) return std::nullopt;
  octomap.edit(edits.placed(poses));
  return octomap;
}

}  // namespace voxlist::desk
