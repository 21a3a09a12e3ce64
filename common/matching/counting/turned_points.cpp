#include "voxlist/matching/counting/turned_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "voxlist/geometry/elementary.h"

namespace voxlist::matching {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

// There are so many times the angles that exact arithmetic would need, so that rounding (of floats,
// 1e-7) never makes a point move by more than a cell from one angle to the next. Bounds rest on it.
constexpr double kSlack = 1.001;

// This is std::floor without a call.
std::int32_t rounded_down(float value) {
  const auto whole = static_cast<std::int32_t>(value);
  return whole - (value < static_cast<float>(whole) ? 1 : 0);
}

}  // namespace

// Turns points by the angles of a group.
class TurnedPoints::Turn {
 public:
  Turn(const TurnedPoints& points, std::int32_t group) {
    for (std::int32_t a = 0; a < kGroup; ++a) {
      const double yaw_rad = points.yaw_rad(group * kGroup + a);
      const auto i = static_cast<std::size_t>(a);
      const auto [sine, cosine] = elementary::sine_cosine(yaw_rad);
      cosines_[i] = static_cast<float>(cosine / points.map_.cell_m());
      sines_[i] = static_cast<float>(sine / points.map_.cell_m());
    }
  }

  Cells cells(const Eigen::Vector2f& p) const {
    Cells cells;
    for (std::size_t a = 0; a < cells.size(); ++a) {
      cells[a] = {rounded_down(cosines_[a] * p.x() - sines_[a] * p.y()),
                  rounded_down(sines_[a] * p.x() + cosines_[a] * p.y())};
    }
    return cells;
  }

  struct Box {
    Cell low, high;
  };

  // The box of all cells.
  static Box box(const Cells& cells) {
    Box box{cells[0], cells[0]};
    for (const Cell& cell : cells) {
      box.low = {std::min(box.low.x, cell.x), std::min(box.low.y, cell.y)};
      box.high = {std::max(box.high.x, cell.x), std::max(box.high.y, cell.y)};
    }
    return box;
  }

  // The box of each part's cells.
  static std::array<Box, kParts> boxes(const Cells& cells) {
    std::array<Box, kParts> boxes;
    for (std::size_t part = kParts; part-- > 0;) {
      if (part >= std::size_t{kFirstSingle}) {
        const Cell& cell = cells[part - std::size_t{kFirstSingle}];
        boxes[part] = {cell, cell};
      } else {
        const Box &a = boxes[2 * part + 1], &b = boxes[2 * part + 2];
        boxes[part] = {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y)},
                       {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y)}};
      }
    }
    return boxes;
  }

 private:
  std::array<float, kGroup> cosines_, sines_;
};

TurnedPoints::TurnedPoints(const DilatedMap& map, std::span<const Eigen::Vector3f> points)
    : map_(map) {
  double radius_m = map.cell_m();
  for (const auto& p : points) {
    const std::int32_t z = map.layer(static_cast<double>(p.z()));
    if (z < 0 || z >= map.size_z()) continue;
    points_.emplace_back(p.x(), p.y());
    layers_.push_back(z);
    radius_m = std::max(radius_m, elementary::hypot(double(p.x()), double(p.y())));
  }
  groups_ =
      static_cast<std::int32_t>(std::ceil(kSlack * kTwoPi * radius_m / map.cell_m() / kGroup));
  places_.resize(static_cast<std::size_t>(groups_));
}

double TurnedPoints::yaw_rad(std::int32_t angle) const { return kTwoPi * angle / angles(); }

std::vector<std::int64_t> TurnedPoints::coarse_cells(std::int32_t group,
                                                     const CoarseMap& map) const {
  const Turn turn(*this, group);
  std::vector<std::int64_t> bits;
  bits.reserve(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto [low, high] = turn.box(turn.cells(points_[i]));
    // A point takes the wide grid when it comes beyond 16 cells from its coarse cell's start at the
    // node's last translation.
    constexpr std::int32_t kFactor = CoarseMap::kFactor;
    const std::int32_t x = floor_div(low.x, kFactor), y = floor_div(low.y, kFactor);
    bits.push_back(
        map.bit(high.x - x * kFactor > kFactor, high.y - y * kFactor > kFactor, x, y, layers_[i]));
  }
  return bits;
}

std::span<const DilatedMap::Place> TurnedPoints::places(std::int32_t group, std::int32_t part) {
  const auto& places = places_[static_cast<std::size_t>(group)];
  if (places.empty()) make_places(group);
  return std::span(places).subspan(static_cast<std::size_t>(part) * size(), size());
}

void TurnedPoints::make_places(std::int32_t group) {
  auto& places = places_[static_cast<std::size_t>(group)];
  places.resize(std::size_t{kParts} * size());
  const Turn turn(*this, group);
  for (std::size_t i = 0; i < size(); ++i) {
    const auto boxes = turn.boxes(turn.cells(points_[i]));
    for (std::size_t part = 0; part < boxes.size(); ++part) {
      const auto& [low, high] = boxes[part];
      const int moves = std::max(high.x - low.x, high.y - low.y);
      places[part * size() + i] =
          map_.place(low.x, low.y, layers_[i], std::bit_width(static_cast<unsigned>(moves)));
    }
  }
}

}  // namespace voxlist::matching
