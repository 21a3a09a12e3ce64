// Makes a map folder of a drive round a block of houses, bent so that closing its loop moves it.
// Usage: bent_map FOLDER [BLOCKS]: so many blocks beside each other (1)
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "tests/mapping/loops/bent_block.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::mapping {
namespace {

// From one block to the next (m); so many in a row.
constexpr double kNext_m = 60.0;
constexpr int kInRow = 14;

void write(const char* folder, int blocks) {
  MapStore store(folder, 1, [](Keyframe) {});
  const std::vector<Pose2> truth = way_round(12.0), bent = mapping::bent(truth);
  std::vector<Cloud> seen;
  for (std::size_t i = 0; i < truth.size(); ++i) seen.push_back(scan_block(truth[i], i + 1));
  std::int64_t seconds = 0;
  for (int block = 0; block < blocks; ++block) {
    const Pose2 there{kNext_m * (block % kInRow), kNext_m * (block / kInRow), 0.0};
    for (std::size_t i = 0; i < truth.size(); ++i) {
      Keyframe keyframe{to_pose3(there * bent[i]), seen[i]};
      keyframe.cloud.utime_us = ++seconds * 1'000'000;
      store.append(keyframe);
    }
  }
}

}  // namespace
}  // namespace voxlist::mapping

int main(int argc, char** argv) try {
  if (argc < 2 || argc > 3) return 2;
  voxlist::mapping::write(argv[1], argc > 2 ? std::atoi(argv[2]) : 1);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bent_map: %s\n", error.what());
  return 1;
}
