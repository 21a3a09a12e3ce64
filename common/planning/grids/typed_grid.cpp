#include "voxlist/planning/grids/typed_grid.h"

#include <algorithm>
#include <cmath>

#include "voxlist/planning/grids/cell_array.h"

namespace voxlist::planning {
namespace {

constexpr double kLayer_m = kFinestResolution_m;

// What hangs lower than this above the floor stands on it: no robot passes under it (m).
constexpr double kPassage_m = 0.2;

// A floor is free where this share of the space above it was seen to be free, up to the robot's
// height or to what hangs there: a wall that was hit in lines has none.
constexpr double kSeenFree = 0.5;

// Voxels and cells are told apart from a floor to so much (m).
constexpr double kSlack_m = 0.01, kBelow_m = 0.04;

// A surface that hangs is taken to go on between cells where it was hit, which are as high to so
// much (m), and so near to each other that the robot does not fit between: rays that pass under a
// table meet its top in lines. So many times, for lines that run either way.
constexpr float kLevel_m = 0.04F;
constexpr int kClosings = 2;

// What a column is for a robot, and where the surface is that hangs in it (m).
struct Typed {
  CellType type = CellType::kUnknown;
  float hangs_m = 0.0F;
};

// Types one column.
class Typing {
 public:
  Typing(const Column& column, Footing footing, double floor_m, const RobotProfile& robot)
      : column_(column), footing_(footing), floor_m_(floor_m), robot_(robot) {}

  Typed type() const {
    const Span* blocks = lowest_that_blocks();
    const bool hangs = blocks != nullptr && is_free_under(blocks->bottom * kLayer_m);
    if (blocks != nullptr && !hangs) return {CellType::kObstacle};
    if (!has_floor() && drops()) return {CellType::kNegative};
    if (hangs) return {CellType::kOverhang, blocks->surface_m};
    const bool is_free = has_floor() && is_seen_free_to(floor_m_ + robot_.clear_height_m());
    return {is_free ? CellType::kFree : CellType::kUnknown};
  }

 private:
  bool has_floor() const { return footing_ >= Footing::kBridged; }

  // What the robot would touch first. Without a floor of its own, what is as high
  // as a step blocks as a whole: a kerb.
  const Span* lowest_that_blocks() const {
    for (const Span& span : column_.spans) {
      if (span.bottom * kLayer_m >= floor_m_ + robot_.clear_height_m()) return nullptr;
      const bool is_kerb = !has_floor() && span.surface_m > floor_m_ + kSlack_m;
      if (is_kerb || (span.top - 1) * kLayer_m >= floor_m_ + robot_.step_m) return &span;
    }
    return nullptr;
  }

  bool is_free_under(double blocked_m) const {
    return blocked_m - floor_m_ >= kPassage_m && is_seen_free_to(blocked_m);
  }

  bool is_seen_free_to(double top_m) const {
    double free_m = 0.0;
    for (const FreeRun& run : column_.free)
      free_m += std::max(
          0.0, std::min(run.top * kColumn_m, top_m) - std::max(run.bottom * kColumn_m, floor_m_));
    return free_m >= kSeenFree * (top_m - floor_m_);
  }

  // A lower floor is seen, or rays passed where this one would be and on below.
  bool drops() const {
    const double step_down_m = floor_m_ - robot_.step_m - kSlack_m;
    for (const Span& span : column_.spans)
      if (span.surface_m < step_down_m && span.surface_m > floor_m_ - kShallow_m) return true;
    return std::ranges::any_of(column_.free, [&](const FreeRun& run) {
      return run.top * kColumn_m >= floor_m_ - kBelow_m &&
             run.bottom * kColumn_m <= floor_m_ - kColumn_m - kBelow_m;
    });
  }

  // A drop that shows by its floor alone: rays pass a cell of the floor's own height either way.
  static constexpr double kShallow_m = 0.3;

  const Column& column_;
  const Footing footing_;
  const double floor_m_;
  const RobotProfile& robot_;
};

// Cells between which one surface hangs.
class Hanging {
 public:
  Hanging(TypedGrid& grid, std::vector<float> hangs_m, double width_m)
      : grid_(grid),
        hangs_m_(std::move(hangs_m)),
        farthest_(static_cast<std::int32_t>(width_m / kColumn_m)) {}

  void close() {
    std::vector<Between> between;
    for (std::int32_t y = grid_.box.low.y; y < grid_.box.high.y; ++y)
      for (std::int32_t x = grid_.box.low.x; x < grid_.box.high.x; ++x)
        if (grid_.at({x, y}) == CellType::kOverhang)
          for (const Cell& way : kWays) close_from({x, y}, way, between);
    for (const Between& at : between) {
      grid_.cells[at.cell] = CellType::kOverhang;
      hangs_m_[at.cell] = at.hangs_m;
    }
  }

 private:
  struct Between {
    std::size_t cell;
    float hangs_m;
  };
  static constexpr Cell kWays[] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};

  void close_from(const Cell& from, const Cell& way, std::vector<Between>& between) const {
    for (std::int32_t k = 1; k <= farthest_; ++k) {
      const Cell cell{from.x + k * way.x, from.y + k * way.y};
      if (!grid_.box.contains(cell)) return;
      const CellType type = grid_.at(cell);
      if (type == CellType::kFree) continue;
      if (type != CellType::kOverhang || !is_level(from, cell)) return;
      for (std::int32_t i = 1; i < k; ++i)
        between.push_back({grid_.box.index({from.x + i * way.x, from.y + i * way.y}),
                           hangs_m_[grid_.box.index(from)]});
      return;
    }
  }

  bool is_level(const Cell& a, const Cell& b) const {
    return std::abs(hangs_m_[grid_.box.index(a)] - hangs_m_[grid_.box.index(b)]) <= kLevel_m;
  }

  TypedGrid& grid_;
  std::vector<float> hangs_m_;
  const std::int32_t farthest_;
};

}  // namespace

std::int32_t typing_margin(const RobotProfile& robot) {
  return kClosings * static_cast<std::int32_t>(2.0 * robot.radius_m / kColumn_m);
}

TypedGrid type_cells(const FloorColumns& columns, const Ground& ground, const RobotProfile& robot,
                     const CellBox& box) {
  const CellBox whole = common_part(grown(box, typing_margin(robot)), ground.box());
  TypedGrid grid{whole, std::vector<CellType>(whole.size(), CellType::kUnknown)};
  std::vector<float> hangs_m(whole.size());
  for (std::int32_t y = whole.low.y; y < whole.high.y; ++y)
    for (std::int32_t x = whole.low.x; x < whole.high.x; ++x) {
      const Cell cell{x, y};
      const Footing footing = ground.footing(cell);
      if (footing == Footing::kNone) continue;
      const Column column = columns.at(cell);
      const Typed typed = Typing(column, footing, ground.height_m(cell), robot).type();
      grid.cells[whole.index(cell)] = typed.type;
      hangs_m[whole.index(cell)] = typed.hangs_m;
    }
  Hanging hanging(grid, std::move(hangs_m), 2.0 * robot.radius_m);
  for (int i = 0; i < kClosings; ++i) hanging.close();
  const CellBox part = common_part(box, whole);
  if (part == whole) return grid;
  return {part, relaid(whole, grid.cells, part, CellType::kUnknown)};
}

}  // namespace voxlist::planning
