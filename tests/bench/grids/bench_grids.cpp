// Grids of simulated buildings for a low robot and a tall one, against what is truly there.
// Arguments: FIRST_SEED LAST_SEED [PICTURES_FOLDER]; without: seed 1.
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "tests/bench/grids/grid_scene.h"
#include "tests/bench/grids/true_grid.h"
#include "voxlist/planning/grids/grid_files.h"

namespace voxlist::bench {
namespace {

using planning::Cell;
using planning::CellType;

constexpr const char* kTypes[] = {"unknown", "free", "obstacle", "overhang", "negative"};
constexpr const char* kTrue[] = {"free", "obstacle", "overhang", "hole", "border"};

planning::RobotProfile profile(const char* name, double height_m) {
  planning::RobotProfile robot;
  robot.name = name;
  robot.height_m = height_m;
  return robot;
}

// Its floor was hit.
bool is_seen(const planning::Column& column) {
  for (const planning::Span& span : column.spans)
    if (span.surface_m > -0.06F && span.surface_m < 0.06F) return true;
  return false;
}

using Counts = std::array<std::array<long, 5>, 5>;  // truth, then type

void print(const char* robot, int seed, const Counts& counts) {
  std::printf("seed %d, %s\n%10s", seed, robot, "true");
  for (const char* type : kTypes) std::printf("%10s", type);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    std::printf("\n%10s", kTrue[i]);
    for (const long count : counts[i]) std::printf("%10ld", count);
  }
  long truly_free = 0;
  for (const long count : counts[0]) truly_free += count;
  const long wrongly_free = counts[1][1] + counts[2][1] + counts[3][1];
  std::printf("\nfree IoU %.4f, wrongly free %ld\n",
              static_cast<double>(counts[0][1]) / static_cast<double>(truly_free + wrongly_free),
              wrongly_free);
}

void list(const planning::TypedGrid& grid, const Cell& cell, TrueCell truth) {
  if (std::getenv("VOXLIST_LIST") && truth != TrueCell::kBorder && truth != TrueCell::kFree &&
      grid.at(cell) == CellType::kFree)
    std::printf("  %s is free at %.2f %.2f\n", kTrue[static_cast<int>(truth)],
                (cell.x + 0.5) * planning::kColumn_m, (cell.y + 0.5) * planning::kColumn_m);
}

Counts compare(const GridScene& scene, const planning::FloorColumns& columns,
               const planning::TypedGrid& grid, const planning::RobotProfile& robot) {
  Counts counts{};
  for (std::int32_t y = grid.box.low.y; y < grid.box.high.y; ++y)
    for (std::int32_t x = grid.box.low.x; x < grid.box.high.x; ++x) {
      const Cell cell{x, y};
      if (!is_seen(columns.at(cell)) && grid.at(cell) == CellType::kUnknown) continue;
      const TrueCell truth = true_cell(scene.building, cell, robot);
      ++counts[static_cast<std::size_t>(truth)][static_cast<std::size_t>(grid.at(cell))];
      list(grid, cell, truth);
    }
  return counts;
}

void run(int seed, const char* pictures) {
  const GridScene scene = grid_scene(seed);
  std::vector<Eigen::Vector3d> way;
  for (const StampedPose3& pose : scene.map.poses()) way.push_back(pose.pose.translation());
  using Clock = std::chrono::steady_clock;
  const auto a = Clock::now();
  planning::FloorColumns columns;
  columns.take(scene.map.map(), scene.map.free_space());
  const auto b = Clock::now();
  for (const auto& robot : {profile("low", 0.4), profile("tall", 1.7)}) {
    const auto c = Clock::now();
    const planning::Ground ground(columns, planning::driven_cells(way), robot.step_m);
    const auto d = Clock::now();
    const planning::TypedGrid grid = planning::type_cells(columns, ground, robot);
    const auto e = Clock::now();
    const auto ms = [](auto from, auto to) {
      return std::chrono::duration<double, std::milli>(to - from).count();
    };
    std::printf("%zu keyframes, %d x %d cells: columns %.1f ms, ground %.1f ms, types %.1f ms\n",
                way.size(), grid.box.width(), grid.box.height(), ms(a, b), ms(c, d), ms(d, e));
    print(robot.name.c_str(), seed, compare(scene, columns, grid, robot));
    if (pictures) planning::write_grid(grid, pictures, robot.name + std::to_string(seed));
  }
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  const int first = argc > 1 ? std::atoi(argv[1]) : 1, last = argc > 2 ? std::atoi(argv[2]) : first;
  for (int seed = first; seed <= last; ++seed)
    voxlist::bench::run(seed, argc > 3 ? argv[3] : nullptr);
}
