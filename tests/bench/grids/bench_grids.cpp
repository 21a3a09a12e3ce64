// Grids of simulated buildings for a low robot and a tall one, against what is truly there.
// Arguments: FIRST_SEED LAST_SEED [PICTURES_FOLDER], or "large": time and memory of a map of 200 x
// 150 m; without: seed 1.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "tests/bench/grids/grid_scene.h"
#include "tests/bench/grids/large_floor.h"
#include "tests/bench/grids/true_grid.h"
#include "voxlist/planning/grids/grid_builder.h"
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

// What cells truly are, and what they are typed as.
struct Counts {
  std::array<std::array<long, 5>, 5> cells{};
  long free_alone = 0;  // obstacles and holes typed free, with nothing but free cells about them

  long& at(TrueCell truth, CellType type) {
    return cells[static_cast<std::size_t>(truth)][static_cast<std::size_t>(type)];
  }

  void add(const Counts& other) {
    for (std::size_t i = 0; i < cells.size(); ++i)
      for (std::size_t j = 0; j < cells[i].size(); ++j) cells[i][j] += other.cells[i][j];
    free_alone += other.free_alone;
  }
};

void print(const std::string& title, const Counts& counts) {
  std::printf("%s\n%10s", title.c_str(), "true");
  for (const char* type : kTypes) std::printf("%10s", type);
  for (std::size_t i = 0; i < counts.cells.size(); ++i) {
    std::printf("\n%10s", kTrue[i]);
    for (const long count : counts.cells[i]) std::printf("%10ld", count);
  }
  const auto& c = counts.cells;
  long truly_free = 0;
  for (const long count : c[0]) truly_free += count;
  const long wrong = c[1][1] + c[2][1] + c[3][1];
  const long hanging = c[2][1] + c[2][2] + c[2][3] + c[2][4];
  std::printf(
      "\nfree IoU %.4f; typed free: %ld obstacles and holes (%ld not beside one that is "
      "told), %ld of %ld overhangs\n",
      static_cast<double>(c[0][1]) / static_cast<double>(truly_free + wrong), c[1][1] + c[3][1],
      counts.free_alone, c[2][1], hanging);
}

bool is_among_free_cells(const planning::TypedGrid& grid, const Cell& cell) {
  for (std::int32_t i = 0; i < 9; ++i) {
    const Cell beside{cell.x + i % 3 - 1, cell.y + i / 3 - 1};
    if (grid.box.contains(beside) && grid.at(beside) != CellType::kFree) return false;
  }
  return true;
}

Counts compare(const simulation::Building& building, const planning::FloorColumns& columns,
               const planning::TypedGrid& grid, const planning::RobotProfile& robot) {
  Counts counts;
  for (std::int32_t y = grid.box.low.y; y < grid.box.high.y; ++y)
    for (std::int32_t x = grid.box.low.x; x < grid.box.high.x; ++x) {
      const Cell cell{x, y};
      const CellType type = grid.at(cell);
      if (!is_seen(columns.at(cell)) && type == CellType::kUnknown) continue;
      const TrueCell truth = true_cell(building, cell, robot);
      ++counts.at(truth, type);
      const bool is_bad = truth == TrueCell::kObstacle || truth == TrueCell::kHole;
      if (is_bad && type == CellType::kFree && is_among_free_cells(grid, cell)) ++counts.free_alone;
    }
  return counts;
}

std::vector<planning::RobotProfile> robots() { return {profile("low", 0.4), profile("tall", 1.7)}; }

void run_buildings(int first, int last, const char* pictures) {
  std::array<Counts, 2> all;
  for (int seed = first; seed <= last; ++seed) {
    const GridScene scene = grid_scene(seed);
    std::vector<Eigen::Vector3d> way;
    for (const StampedPose3& pose : scene.map.poses()) way.push_back(pose.pose.translation());
    planning::GridBuilder builder(robots());
    builder.drive(way);
    builder.take(scene.map.map(), scene.map.free_space());
    builder.update();
    const auto& grids = builder.grids();
    for (std::size_t i = 0; i < grids.size(); ++i) {
      const std::string name = builder.robots()[i].name + std::to_string(seed);
      const Counts counts =
          compare(scene.building, builder.columns(), grids[i], builder.robots()[i]);
      print(name, counts);
      all[i].add(counts);
      if (pictures) planning::write_grid(grids[i], pictures, name);
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) print("all, " + robots()[i].name, all[i]);
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "large") == 0) {
    voxlist::bench::run_large_floor();
    return 0;
  }
  const int first = argc > 1 ? std::atoi(argv[1]) : 1, last = argc > 2 ? std::atoi(argv[2]) : first;
  voxlist::bench::run_buildings(first, last, argc > 3 ? argv[3] : nullptr);
}
