#include "tests/bench/grids/large_floor.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "services/grid_export/grid_messages.h"
#include "tests/bench/figures.h"
#include "voxlist/planning/grids/grid_builder.h"
#include "voxlist/system/memory.h"

namespace voxlist::bench {
namespace {

using planning::CellType;

constexpr std::int32_t kTilesX = 312, kTilesY = 234;  // of 0.64 m

VoxelBlock filled(std::uint64_t layer) {
  VoxelBlock block;
  block.fill(layer);
  return block;
}

// Walls every 5 m along x, doors of 1.3 m in them, a ceiling; small things stand about all over.
class LargeFloor {
 public:
  // What stands over a tile of 0.64 m. Tells which blocks that is.
  void add(std::int32_t x, std::int32_t y) {
    const bool is_wall = x % 8 == 7 && y % 8 > 1;
    for (std::int32_t z = 0; z < 4 && !is_wall; ++z)
      put({x, y, z}, filled(~std::uint64_t{0}), free.passed, changed_free.passed);
    for (std::int32_t i = 0; i < 16; ++i) add_column({4 * x + i % 4, 4 * y + i / 4, 0}, is_wall);
    if (y % 8 > 1) add_thing(x, y);
  }

  OccupancyMap map, free{VoxelMap(kPassedResolution_m), VoxelMap(kPassedResolution_m)};
  ChangedBlocks changed, changed_free;

 private:
  // Blocks of 0.16 m above each other.
  void add_column(const Voxel& at, bool is_wall) {
    VoxelBlock floor{}, ceiling{};
    floor.back() = ceiling.front() = ~std::uint64_t{0};
    put({at.x, at.y, -1}, floor, map.occupied, changed.occupied);
    put({at.x, at.y, 16}, ceiling, map.occupied, changed.occupied);
    for (std::int32_t z = 0; z < 16 && is_wall; ++z)
      put({at.x, at.y, z}, filled(1), map.occupied, changed.occupied);
  }

  // 0.1 m high, anywhere on a tile.
  void add_thing(std::int32_t x, std::int32_t y) {
    const auto place = static_cast<std::uint32_t>(x + 1000 * y) * 2654435761U;
    const auto i = static_cast<std::int32_t>(place >> 28);
    VoxelBlock thing{};
    for (std::size_t z = 0; z < 5; ++z) thing[z] = std::uint64_t{0x10f0f1f0} << (place >> 4) % 30;
    put({4 * x + i % 4, 4 * y + i / 4, 0}, thing, map.occupied, changed.occupied);
  }

  static void put(const Voxel& at, const VoxelBlock& bits, VoxelMap& blocks,
                  std::vector<Voxel>& list) {
    blocks.set_block(at, bits);
    list.push_back(at);
  }
};

// Along each row of doors.
std::vector<Eigen::Vector3d> lap() {
  std::vector<Eigen::Vector3d> way;
  for (double y = 0.64; y < kTilesY * 0.64; y += 8 * 0.64)
    for (double x = 0.5; x < kTilesX * 0.64; x += 0.3) way.emplace_back(x, y, 0.0);
  return way;
}

bool is_near(std::int32_t x, std::int32_t y) {
  return std::hypot((x + 0.5) * 0.64 - 100.0, (y + 0.5) * 0.64 - 75.0) < 8.0;
}

template <class Take>
void for_each_tile(const Take& take) {
  for (std::int32_t y = 0; y < kTilesY; ++y)
    for (std::int32_t x = 0; x < kTilesX; ++x) take(x, y);
}

double resident_mb() { return static_cast<double>(memory_of_process()) * 1e-6; }

class Watch {
 public:
  double ms() const { return cpu_ms() - start_ms_; }

 private:
  double start_ms_ = cpu_ms();
};

// Makes four messages, and tells their size.
std::size_t messages(const planning::GridBuilder& builder,
                     std::vector<services::BandedZlib>& zlibs) {
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < builder.grids().size(); ++i) {
    const planning::TypedGrid& grid = builder.grids()[i];
    bytes += services::to_pixel_map(grid, {}, zlibs[2 * i]).mapData.size() +
             services::to_traversability(grid, {}, "robot", zlibs[2 * i + 1]).cells.size();
  }
  return bytes;
}

}  // namespace

void run_large_floor() {
  LargeFloor floor;
  for_each_tile([&](auto x, auto y) { is_near(x, y) ? void() : floor.add(x, y); });
  std::vector<planning::RobotProfile> robots(2);
  robots[0].height_m = 0.4;
  robots[1].height_m = 1.7;
  const double before_mb = resident_mb();
  planning::GridBuilder builder(robots);
  const Watch take;
  builder.take(floor.map, floor.free);
  std::printf("columns of all: %.0f ms, %.0f MB of columns\n", take.ms(),
              static_cast<double>(builder.columns().memory_bytes()) * 1e-6);
  auto way = lap();
  builder.drive(way);
  const Watch begin;
  builder.update();
  const planning::CellBox box = builder.grids().front().box;
  std::printf("%d x %d cells, 2 grids: %.0f ms, %.0f MB more than the map's\n", box.width(),
              box.height(), begin.ms(), resident_mb() - before_mb);

  std::vector<services::BandedZlib> zlibs(4);
  const Watch first;
  std::size_t bytes = messages(builder, zlibs);
  std::printf("their messages: %.0f ms, %.1f MB\n", first.ms(), static_cast<double>(bytes) * 1e-6);

  floor.changed = floor.changed_free = {};
  for_each_tile([&](auto x, auto y) { is_near(x, y) ? floor.add(x, y) : void(); });
  way.emplace_back(100.0, 75.0, 0.0);
  const auto free_cells = [&] {
    return std::ranges::count(builder.grids().front().cells, CellType::kFree);
  };
  const auto free_before = free_cells();
  const Watch follow;
  builder.drive(way);
  builder.follow(floor.map, floor.changed, floor.free, floor.changed_free);
  const double columns_ms = follow.ms();
  builder.update();
  std::printf("all within 8 m is new: columns %.0f ms, with grids %.0f ms; free cells %+ld\n",
              columns_ms, follow.ms(), static_cast<long>(free_cells() - free_before));
  const Watch again;
  bytes = messages(builder, zlibs);
  std::printf("their messages: %.0f ms, %.1f MB\n", again.ms(), static_cast<double>(bytes) * 1e-6);
  const Watch forget;
  builder.drive({});
  builder.update();
  std::printf("all of the way is forgotten: %.0f ms\n", forget.ms());
}

}  // namespace voxlist::bench
