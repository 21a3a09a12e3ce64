// A planner as its author would write it: it hears GRID_NAME, and plans anew whenever the grid has
// changed. It keeps the robot's radius away from all cells that are not known to be free.
// Usage: grid_planner CHANNEL RADIUS_M X Y GOAL_X GOAL_Y: writes each plan's points, "X Y" a line,
// and an empty line. With LCM_DEFAULT_URL="file://LOG?speed=0" it reads a recording.
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <queue>
#include <utility>
#include <vector>
#include <voxlist/pixel_map_t.hpp>

struct Grid {
  Grid(const voxlist::pixel_map_t& message, double radius_m)
      : map(message), width(map.dimensions[0]), height(map.dimensions[1]), cells(map.mapData) {
    uLongf bytes = uLongf(width * height);
    cells.resize(bytes, 255);
    if (map.compressed != 0)
      uncompress(cells.data(), &bytes, map.mapData.data(), map.mapData.size());
    for (int i = 0; i < width * height; ++i)
      room.push_back(has_room(i % width, i / width, radius_m));
  }

  // Writes the middles of cells on a shortest way, by Dijkstra's rule from the goal; nothing where
  // there is none. Cells at the border have no room: no step leads out of the grid.
  void plan(double x, double y, double goal_x, double goal_y) const {
    const int start = cell_at(x, y), goal = cell_at(goal_x, goal_y);
    std::map<int, std::pair<double, int>> found;  // by cell: its price, and the next cell
    std::priority_queue<std::pair<double, int>> open;
    const auto visit = [&](int cell, double price, int next) {
      if (!room[std::size_t(cell)] || (found.contains(cell) && found[cell].first <= price)) return;
      found[cell] = {price, next};
      open.emplace(-price, cell);
    };
    if (goal >= 0) visit(goal, 0.0, -1);
    while (!open.empty() && open.top().second != start) {
      const auto [price, cell] = open.top();
      open.pop();
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          visit(cell + dy * width + dx, std::hypot(dx, dy) - price, cell);
    }
    for (int cell = start; found.contains(cell); cell = found[cell].second)
      std::cout << map.xy0[0] + (cell % width + 0.5) * map.mpp << ' '
                << map.xy0[1] + (cell / width + 0.5) * map.mpp << '\n';
  }

  bool is_free(int x, int y) const {
    return x >= 0 && y >= 0 && x < width && y < height && cells[std::size_t(y * width + x)] == 0;
  }

  int cell_at(double x, double y) const {
    const int column = int(std::floor((x - map.xy0[0]) / map.mpp)),
              row = int(std::floor((y - map.xy0[1]) / map.mpp));
    return is_free(column, row) ? row * width + column : -1;
  }

  // Whether a robot in the middle of a cell reaches into free cells alone.
  bool has_room(int x, int y, double radius_m) const {
    const int reach = int(radius_m / map.mpp + 1.0);
    const auto gap = [](int steps) { return std::max(0.0, std::abs(steps) - 0.5); };
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx)
        if (std::hypot(gap(dx), gap(dy)) * map.mpp < radius_m && !is_free(x + dx, y + dy))
          return false;
    return true;
  }

  const voxlist::pixel_map_t& map;
  const int width, height;
  std::vector<unsigned char> cells;
  std::vector<bool> room;
};

struct Planner {
  void on_grid(const lcm::ReceiveBuffer*, const std::string&, const voxlist::pixel_map_t* map) {
    if (map->mapData == seen) return;  // nothing has changed
    seen = map->mapData;
    Grid(*map, radius_m).plan(x, y, goal_x, goal_y);
    std::cout << std::endl;
  }

  double radius_m, x, y, goal_x, goal_y;
  std::vector<unsigned char> seen = {};
};

int main(int argc, char** argv) {
  lcm::LCM lcm;
  if (argc < 7 || !lcm.good()) return 2;
  Planner planner{std::atof(argv[2]), std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[5]),
                  std::atof(argv[6])};
  lcm.subscribe(argv[1], &Planner::on_grid, &planner);
  while (lcm.handle() == 0) continue;
}
