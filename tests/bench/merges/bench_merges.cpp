// Maps of twin buildings, which voxlist merge would join or not: offices of which none can be told
// from another, in one wing, in two, and in mirrored ones. A merge is wrong where it puts the other
// map more than 0.3 m or 3 deg off, or where the two are of different buildings. Arguments, each
// optional: first seed; last seed; offices (12). CPU time of one thread.
#include <tbb/global_control.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "services/voxlist/maps/meeting.h"
#include "tests/bench/drives/twin_drive.h"
#include "tests/bench/figures.h"
#include "tests/simulation/sphere_scan.h"

namespace voxlist::bench {
namespace {

constexpr double kWrong_m = 0.3, kWrong_rad = 0.05;
// The other map has a frame of its own.
const Pose2 kOther{3.0, -7.0, 0.8};

// A stretch of a drive, as shares of its way.
struct Stretch {
  double begin = 0.0, end = 1.0;
};

Cloud mirrored(Cloud scan) {
  for (auto& point : scan.points) point.y() = -point.y();
  for (auto& origin : scan.origins) origin.y() = -origin.y();
  return scan;
}

Pose2 mirrored(const Pose2& pose) { return {pose.x_m, -pose.y_m, -pose.yaw_rad}; }

class Maps {
 public:
  Maps(simulation::Building building, int seed) : building_(std::move(building)), seed_(seed) {}

  // Without its way back along the corridor: that would be ground of all maps.
  std::unique_ptr<mapping::Piece> map(const Stretch& stretch, const Pose2& T_map_world,
                                      bool is_mirrored, mapping::KeyframeSpool& spool) const {
    const TwinDrive drive = twin_drive(building_, false, seed_);
    const simulation::World world(building_);
    auto piece =
        std::make_unique<mapping::Piece>(matching::LocaliserConfig{}, mapping::MapBuilder(), spool);
    const auto out = static_cast<double>(drive.truth.size()) - building_.rooms.back().door.x();
    for (auto i = static_cast<std::size_t>(stretch.begin * out);
         i < static_cast<std::size_t>(stretch.end * out); ++i) {
      const auto noise = static_cast<std::uint64_t>(10'000 * seed_) + 7 * i +
                         (is_mirrored ? 3 : 0) + static_cast<std::uint64_t>(100 * stretch.begin);
      Cloud scan = simulation::scan_sphere(world, drive.truth[i],
                                           {.rays = 8000, .range_max_m = 15.0}, noise);
      scan.utime_us = static_cast<std::int64_t>(i + 1) * 1'000'000;
      const Pose2& pose = drive.truth[i];
      piece->add(is_mirrored ? mirrored(std::move(scan)) : std::move(scan),
                 to_pose3(T_map_world * (is_mirrored ? mirrored(pose) : pose)));
    }
    return piece;
  }

 private:
  simulation::Building building_;
  int seed_;
};

// Offices that differ, as most do.
simulation::Building offices(int rooms, int seed) {
  simulation::BuildingConfig config;
  config.rooms = rooms;
  config.length_m = 2.0 * rooms;
  config.seed = seed;
  return simulation::make_building(config);
}

struct Case {
  const char* name;
  Stretch first, other;
  bool is_mirrored = false, is_larger = false, differs = false;

  // Whether there is a right place for the other map.
  bool is_one_building() const { return !is_mirrored && !is_larger; }
};

constexpr Case kCases[] = {
    {"one wing, all of it twice", {}, {}},
    {"its halves", {0.0, 0.55}, {0.45, 1.0}},
    {"its first and last quarter", {0.0, 0.25}, {0.75, 1.0}},
    {"another wing of the same offices", {}, {}, false, true},
    {"a part of another wing", {}, {0.4, 0.7}, false, true},
    {"the mirrored wing", {}, {}, true},
    {"a part of the mirrored wing", {}, {0.4, 0.7}, true},
    {"offices that differ, all twice", {}, {}, false, false, true},
    {"a half and more of them", {0.0, 0.65}, {0.35, 1.0}, false, false, true},
    {"their halves", {0.0, 0.55}, {0.45, 1.0}, false, false, true}};

struct Count {
  int merged = 0, wrong = 0, refused = 0;
};

void run(const Case& what, int rooms, int seed, Count& count) {
  const auto folder = std::filesystem::temp_directory_path();
  mapping::KeyframeSpool spool(folder);
  const auto building = what.differs ? offices : twin_offices;
  const Maps maps(building(rooms, seed), seed),
      others(building(what.is_larger ? rooms + 2 : rooms, seed), seed);
  const auto map = maps.map(what.first, {}, false, spool);
  const auto other = others.map(what.other, kOther, what.is_mirrored, spool);
  const desk::Meeting met = desk::find_meeting(*map, *other, spool, matching::MatcherConfig());
  if (!met.T_map_other) {
    if (what.differs)
      std::printf("  seed %d: refused, %zu of %zu fit, %zu of them elsewhere, too%s\n", seed,
                  met.fitting, met.asked, met.twins, met.alike ? "; alike" : "");
    return void(++count.refused);
  }
  const Pose2 off = *met.T_map_other * kOther;
  const bool is_right =
      what.is_one_building() && distance_m(off, {}) < kWrong_m && turn_rad(off, {}) < kWrong_rad;
  ++(is_right ? count.merged : count.wrong);
  if (!is_right)
    std::printf("  seed %d, %s: merged %.2f %.2f %.3f, %zu of %zu scans fit\n", seed, what.name,
                off.x_m, off.y_m, off.yaw_rad, met.fitting, met.asked);
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const bool brief = argc > 1 && std::string(argv[1]).starts_with("--");
  const auto argument = [&](int i, int usual) {
    return !brief && argc > i ? std::atoi(argv[i]) : usual;
  };
  const int first = argument(1, 1), last = argument(2, first);
  for (const Case& what : kCases) {
    Count count;
    const double start_ms = cpu_ms();
    for (int seed = first; seed <= last; ++seed)
      run(what, brief ? 2 : argument(3, 12), seed, count);
    std::printf("%-34s merged rightly %d, wrongly %d, refused %d; CPU %.1f s\n", what.name,
                count.merged, count.wrong, count.refused, (cpu_ms() - start_ms) / 1000.0);
    std::fflush(stdout);
    if (brief) break;
  }
}
