// A map folder of a drive through all of a simulated floor, a keyframe in each square with room for
// the robot, as the mapper keeps it. Arguments: folder; keyframes (about, 10000 if not given);
// length and depth of the floor (m, 200 150 if not given); seed.
#include <tbb/parallel_pipeline.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "tests/bench/large/large_floor.h"
#include "voxlist/mapping/keyframe_writer.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::bench {
namespace {

constexpr double kRobotRadius_m = 0.35, kRobotHeight_m = 1.0;
constexpr std::size_t kScansUnderWay = 16;  // bounds memory

// Row by row, to and fro, so that each is near to the one before.
std::vector<Pose2> drive_over(const TestFloor& floor, double step_m, std::uint64_t seed) {
  simulation::Random random(seed, 77);
  std::vector<Pose2> poses;
  int row = 0;
  for (double y = floor.low.y(); y < floor.high.y(); y += step_m, ++row) {
    for (double along = floor.low.x(); along < floor.high.x(); along += step_m) {
      const double x = row % 2 == 0 ? along : floor.low.x() + floor.high.x() - along;
      const Pose2 pose{x, y, random.uniform(-std::numbers::pi, std::numbers::pi)};
      if (floor.building.clearance_m({x, y}, 0.05, kRobotHeight_m) > kRobotRadius_m)
        poses.push_back(pose);
    }
  }
  return poses;
}

// So that about so many places have room: furniture and walls take some of the squares.
std::vector<Pose2> drive_of(const TestFloor& floor, double keyframes, std::uint64_t seed) {
  const double step_m = std::sqrt((floor.high - floor.low).prod() / keyframes);
  const double share = static_cast<double>(drive_over(floor, step_m, seed).size()) / keyframes;
  return drive_over(floor, step_m * std::sqrt(share), seed);
}

// All threads scan; one writes, in the order of the poses.
void write_map(const TestFloor& floor, const std::vector<Pose2>& poses,
               mapping::NewKeyframeFile& file) {
  std::size_t asked = 0, written = 0;
  tbb::parallel_pipeline(
      kScansUnderWay,
      tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order,
                                          [&](tbb::flow_control& flow) {
                                            if (asked == poses.size()) flow.stop();
                                            return asked++;
                                          }) &
          tbb::make_filter<std::size_t, Cloud>(
              tbb::filter_mode::parallel,
              [&](std::size_t i) { return scan_at(floor.building, poses[i], 0, i + 1); }) &
          tbb::make_filter<Cloud, void>(tbb::filter_mode::serial_in_order, [&](Cloud cloud) {
            cloud.utime_us = static_cast<std::int64_t>(written + 1) * 1'000'000;
            file.add({to_pose3(poses[written++]), std::move(cloud)});
          }));
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const auto number = [&](int i, double otherwise) {
    return argc > i ? std::atof(argv[i]) : otherwise;
  };
  if (argc < 2)
    return std::fprintf(stderr, "usage: large_map FOLDER [KEYFRAMES] [LENGTH DEPTH] [SEED]\n"), 1;
  const int seed = static_cast<int>(number(5, 301));
  const TestFloor floor = large_floor(number(3, 200.0), number(4, 150.0), seed);
  const auto poses = drive_of(floor, number(2, 10'000.0), static_cast<std::uint64_t>(seed));
  std::filesystem::create_directories(argv[1]);
  voxlist::mapping::NewKeyframeFile file(
      std::filesystem::path(argv[1]) / voxlist::mapping::kKeyframeFile, seed);
  write_map(floor, poses, file);
  file.commit();
  std::printf("%zu keyframes\n", poses.size());
}
