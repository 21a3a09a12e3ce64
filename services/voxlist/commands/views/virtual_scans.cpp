#include "services/voxlist/commands/views/virtual_scans.h"

#include <fmt/core.h>

#include <iterator>
#include <string>

#include "voxlist/io/files/atomic_file.h"
#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"
#include "voxlist/planning/virtual_scan/virtual_scan.h"

namespace voxlist::desk {
namespace {

// One robot's scans, as text.
struct Tables {
  planning::RobotProfile robot;
  std::string nearest, furthest;
};

std::string header() {
  std::string text = "index,utime,x_m,y_m,yaw_rad,step_rad";
  const int bearings = planning::ScanBand().bearings;
  for (int i = 0; i < bearings; ++i) fmt::format_to(std::back_inserter(text), ",range_{}_m", i);
  return text + "\n";
}

void add_row(const std::string& place, const std::vector<float>& ranges_m, std::string& table) {
  table += place;
  for (const float range_m : ranges_m)
    fmt::format_to(std::back_inserter(table), ",{:.3f}", range_m);
  table += "\n";
}

void add(int index, const mapping::Keyframe& keyframe, Tables& tables) {
  const planning::VirtualScan scan =
      planning::virtual_scan(keyframe.cloud, planning::band_of(tables.robot));
  const Pose2 at = to_pose2(keyframe.T_map_base);
  const std::string place = fmt::format("{},{},{:.6f},{:.6f},{:.9f},{:.9f}", index, scan.utime_us,
                                        at.x_m, at.y_m, at.yaw_rad, scan.step_rad);
  add_row(place, scan.nearest_m, tables.nearest);
  add_row(place, scan.furthest_m, tables.furthest);
}

}  // namespace

void write_virtual_scans(const std::filesystem::path& map, const std::filesystem::path& folder,
                         const std::vector<planning::RobotProfile>& robots, Console& console) {
  std::vector<Tables> all;
  for (const planning::RobotProfile& robot : robots) all.push_back({robot, header(), header()});
  mapping::KeyframeReader reader(map / mapping::kKeyframeFile);
  int index = 0;
  for (; const auto keyframe = reader.next(); ++index)
    for (Tables& tables : all) add(index, *keyframe, tables);
  for (const Tables& tables : all) {
    const auto path = folder / (tables.robot.name + "_scan.csv");
    io::write_file_atomically(path, tables.nearest);
    io::write_file_atomically(folder / (tables.robot.name + "_scan_far.csv"), tables.furthest);
    console.say(fmt::format("{}: {} scans", path.string(), index));
  }
}

}  // namespace voxlist::desk
