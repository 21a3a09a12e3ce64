// Compares the keyframes of a map, which may be made of the maps of several robots, with what
// fleet_watch wrote of each. Usage: fleet_check MAP FILE... Writes a line for each robot:
//   FILE keyframes N wrong N rms_m X max_m X
// Wrong: more than 0.3 m or 6 degrees off, in the frame that the map's first keyframe tells.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <vector>

#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"

namespace {

using namespace voxlist;

constexpr double kWrong_m = 0.3, kWrong_rad = 0.1;

using Truth = std::map<std::int64_t, Pose2>;

Truth read(const char* file) {
  Truth truth;
  std::ifstream in(file);
  Pose2 pose;
  for (std::int64_t utime_us = 0; in >> utime_us >> pose.x_m >> pose.y_m >> pose.yaw_rad;)
    truth[utime_us] = pose;
  return truth;
}

struct Robot {
  const char* file;
  Truth truth;
  int keyframes = 0, wrong = 0;
  double squares_m2 = 0.0, worst_m = 0.0;
};

void compare(const Pose2& found, const Pose2& truth, Robot& robot) {
  const double off_m = distance_m(found, truth);
  ++robot.keyframes;
  if (off_m > kWrong_m || turn_rad(found, truth) > kWrong_rad) ++robot.wrong;
  robot.squares_m2 += off_m * off_m;
  robot.worst_m = std::max(robot.worst_m, off_m);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  std::vector<Robot> robots;
  for (int i = 2; i < argc; ++i) robots.push_back({argv[i], read(argv[i])});
  mapping::KeyframeReader reader(std::filesystem::path(argv[1]) / mapping::kKeyframeFile);
  std::optional<Pose2> T_truth_map;
  int unknown = 0;
  while (const auto keyframe = reader.next()) {
    const std::int64_t utime_us = keyframe->cloud.utime_us;
    const auto robot =
        std::ranges::find_if(robots, [&](const Robot& r) { return r.truth.contains(utime_us); });
    if (robot == robots.end()) {
      ++unknown;
      continue;
    }
    const Pose2 pose = to_pose2(keyframe->T_map_base);
    const Pose2 truth = robot->truth.at(utime_us);
    if (!T_truth_map) T_truth_map = truth * pose.inverse();
    compare(*T_truth_map * pose, truth, *robot);
  }
  for (const Robot& robot : robots)
    std::printf("%s keyframes %d wrong %d rms_m %.3f max_m %.3f\n", robot.file, robot.keyframes,
                robot.wrong, std::sqrt(robot.squares_m2 / std::max(1, robot.keyframes)),
                robot.worst_m);
  std::printf("unknown %d\n", unknown);
  return 0;
}
