#include "voxlist/planning/grids/driven.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxlist::planning {
namespace {

// Floors are looked for so far about the way, and so far below base and above it (m).
constexpr double kAbout_m = 2.0, kDeepest_m = 3.0, kHighest_m = 0.1;

// Heights that are told apart (m).
constexpr double kBin_m = 0.05;

// At base's own height are floors where so many columns say so, of those that say the most.
constexpr double kFew = 0.1;

constexpr std::size_t kPlaces = 100;

// How many columns have a surface at each height, from kDeepest_m below base on.
using Heights = std::array<int, static_cast<std::size_t>((kDeepest_m + kHighest_m) / kBin_m + 0.5)>;

std::size_t bin_of(double height_m) {
  return static_cast<std::size_t>((height_m + kDeepest_m) / kBin_m);
}

std::int32_t cell_at(double m) { return static_cast<std::int32_t>(std::floor(m / kColumn_m)); }

void count_surfaces(const FloorColumns& columns, const Eigen::Vector3d& at, Heights& heights) {
  for (std::int32_t y = cell_at(at.y() - kAbout_m); y <= cell_at(at.y() + kAbout_m); ++y)
    for (std::int32_t x = cell_at(at.x() - kAbout_m); x <= cell_at(at.x() + kAbout_m); ++x)
      for (const Span& span : columns.at({x, y}).spans) {
        const double height_m = span.surface_m - at.z();
        if (height_m < -kDeepest_m || height_m >= kHighest_m - kBin_m / 2) continue;
        ++heights[bin_of(height_m)];
        break;  // the lowest one
      }
}

void add_disc(const Eigen::Vector3d& at, std::vector<DrivenCell>& cells) {
  for (std::int32_t y = cell_at(at.y() - kDriven_m); y <= cell_at(at.y() + kDriven_m); ++y)
    for (std::int32_t x = cell_at(at.x() - kDriven_m); x <= cell_at(at.x() + kDriven_m); ++x) {
      const Eigen::Vector2d centre = Eigen::Vector2d(x + 0.5, y + 0.5) * kColumn_m;
      if ((centre - at.head<2>()).norm() <= kDriven_m)
        cells.push_back({{x, y}, static_cast<float>(at.z())});
    }
}

}  // namespace

float floor_under_base_m(const FloorColumns& columns, const std::vector<Eigen::Vector3d>& way) {
  Heights heights{};
  const std::size_t step = 1 + way.size() / kPlaces;
  for (std::size_t i = 0; i < way.size(); i += step) count_surfaces(columns, way[i], heights);
  const auto most = std::ranges::max_element(heights);
  const int at_base = heights[bin_of(-kBin_m / 2)] + heights[bin_of(kBin_m / 2)];
  if (at_base >= kFew * *most) return 0.0F;
  const auto bin = static_cast<double>(most - heights.begin());
  return static_cast<float>((bin + 0.5) * kBin_m - kDeepest_m);
}

std::vector<DrivenCell> driven_cells(std::span<const Eigen::Vector3d> way) {
  std::vector<DrivenCell> cells;
  for (std::size_t i = 0; i < way.size(); ++i) {
    add_disc(way[i], cells);
    if (i == 0) continue;
    const Eigen::Vector3d step = way[i] - way[i - 1];
    if (step.norm() > kDrivenStep_m) continue;
    const int parts = 1 + static_cast<int>(step.norm() / kColumn_m);
    for (int k = 1; k < parts; ++k) add_disc(way[i - 1] + step * k / parts, cells);
  }
  return cells;
}

void DrivenCells::change_all() {
  for (std::uint32_t i = 0; i < height_m_.size(); ++i)
    changes_.push_back({cells_.key(i).x, cells_.key(i).y});
}

void DrivenCells::forget() {
  change_all();
  cells_ = Numbering<Voxel>();
  height_m_.clear();
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  add({&origin, 1});
}

void DrivenCells::add(std::span<const Eigen::Vector3d> way) {
  for (const DrivenCell& at : driven_cells(way)) {
    const std::uint32_t number = cells_.number({at.cell.x, at.cell.y, 0});
    if (number == height_m_.size())
      height_m_.push_back(at.height_m);
    else if (at.height_m < height_m_[number])
      height_m_[number] = at.height_m;
    else
      continue;
    changes_.push_back(at.cell);
  }
}

bool DrivenCells::drive(const std::vector<std::vector<Eigen::Vector3d>>& ways) {
  const auto goes_on = [](const auto& way, const auto& before) {
    return before.size() <= way.size() && std::equal(before.begin(), before.end(), way.begin());
  };
  const bool all_go_on = ways.size() >= ways_.size() &&
                         std::equal(ways_.begin(), ways_.end(), ways.begin(),
                                    [&](const auto& a, const auto& b) { return goes_on(b, a); });
  if (!all_go_on) {
    ways_.clear();
    forget();
  }
  ways_.resize(ways.size());
  for (std::size_t i = 0; i < ways.size(); ++i) {
    // The way to its new part begins at its last position.
    const std::size_t known = std::max<std::size_t>(ways_[i].size(), 1) - 1;
    if (ways[i].size() > ways_[i].size()) add(std::span(ways[i]).subspan(known));
    ways_[i] = ways[i];
  }
  return all_go_on;
}

void DrivenCells::set_floor_m(float floor_m) {
  if (std::exchange(floor_m_, floor_m) != floor_m) change_all();
}

std::optional<float> DrivenCells::height_m(const Cell& cell) const {
  const std::uint32_t number = cells_.find({cell.x, cell.y, 0});
  if (number == Numbering<Voxel>::kNone) return std::nullopt;
  return height_m_[number] + floor_m_;
}

}  // namespace voxlist::planning
