#include "voxlist/drawing/map_picture.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "voxlist/drawing/map_columns.h"
#include "voxlist/drawing/side_view.h"

namespace voxlist::drawing {
namespace {

using Eigen::Vector2d;

constexpr io::Rgb kBackground{14, 17, 23};
constexpr io::Rgb kInk{226, 230, 236};
constexpr io::Rgb kPath{255, 92, 72};
constexpr io::Rgb kStart{255, 255, 255};
constexpr double kMapPixels = 1460.0;
constexpr int kMargin = 40;
constexpr int kFooter = 84;
constexpr int kWidth = static_cast<int>(kMapPixels) + 2 * kMargin;
constexpr double kTextSize = 20.0;
// Half the height of a digit: moves the baseline so that text stands beside the middle of a mark.
constexpr double kHalfDigit = 0.36 * kTextSize;

double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + std::lround(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

struct Box {
  Vector2d low = Vector2d::Zero();
  Vector2d high = Vector2d::Ones();
};

/// The rectangle that is drawn: all but the few points far out, and the whole path.
Box extent(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3d>& path) {
  constexpr double kOutliers = 0.001;
  Box box;
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<double> values;
    for (const auto& p : points) {
      values.push_back(static_cast<double>(p[axis]));
    }
    if (!values.empty()) {
      box.low[axis] = quantile(values, kOutliers);
      box.high[axis] = quantile(values, 1.0 - kOutliers);
    }
  }
  for (const Eigen::Vector3d& place : path) {
    box.low = box.low.cwiseMin(place.head<2>());
    box.high = box.high.cwiseMax(place.head<2>());
  }
  const double margin = 0.01 * (box.high - box.low).maxCoeff() + 0.1;
  box.low.array() -= margin;
  box.high.array() += margin;
  return box;
}

/// Takes the map frame to pixels of the picture, with the map's longer side across.
class Layout {
 public:
  Layout(const Box& box, double resolution_m) : box_(box) {
    const Vector2d size = box.high - box.low;
    turned_ = size.y() > size.x();
    pixels_per_m_ = kMapPixels / size.maxCoeff();
    // A cell is as wide as a voxel, or as several where a voxel is smaller than a pixel.
    cell_m_ = resolution_m * std::ceil(1.0 / (resolution_m * pixels_per_m_));
  }

  double cell_m() const { return cell_m_; }
  double pixels_per_m() const { return pixels_per_m_; }
  int bottom() const { return static_cast<int>(pixel_size().y()) + kMargin; }

  Vector2d pixel(const Vector2d& p) const {
    const Vector2d across = turned_ ? Vector2d(p.y() - box_.low.y(), p.x() - box_.low.x())
                                    : Vector2d(p.x() - box_.low.x(), box_.high.y() - p.y());
    return (across * pixels_per_m_).array() + kMargin;
  }

  bool shows(const Vector2d& p) const {
    return (p.array() >= box_.low.array()).all() && (p.array() <= box_.high.array()).all();
  }

 private:
  Vector2d pixel_size() const {
    const Vector2d size = (box_.high - box_.low) * pixels_per_m_;
    return turned_ ? Vector2d(size.y(), size.x()) : size;
  }

  Box box_;
  bool turned_;
  double pixels_per_m_;
  double cell_m_;
};

struct HeightRange {
  double low_m = 0.0;
  double high_m = 1.0;

  io::Rgb colour(double height_m) const {
    return io::viridis((height_m - low_m) / (high_m - low_m));
  }
};

/// The heights that the colours span: from the floor to the top of the walls.
HeightRange height_range(const std::vector<MapColumn>& columns) {
  constexpr float kWallM = 0.5F;      // a column with so much above each other is a wall
  constexpr double kOutliers = 0.02;  // share at each end: stray points would take all the colours
  std::vector<double> all, walls;
  for (const MapColumn& column : columns) {
    all.push_back(static_cast<double>(column.top_m));
    if (column.solid_m >= kWallM) {
      walls.push_back(all.back());
    }
  }
  if (all.empty()) {
    return {};
  }
  const double low = quantile(all, kOutliers);
  const double high = quantile(walls.empty() ? all : walls, 1.0 - kOutliers);
  return {low, std::max(high, low + 0.5)};
}

Raster draw_columns(const Layout& layout, const std::vector<MapColumn>& columns,
                    const HeightRange& heights) {
  Raster raster(kWidth, layout.bottom(), kBackground);
  // A single layer has a little more than this share of its colour; so much above each other (m)
  // takes it two thirds of the way to the whole.
  constexpr double kDim = 0.55, kWallM = 0.5;
  for (const MapColumn& column : columns) {
    const Vector2d low = column.cell.cast<double>() * layout.cell_m();
    const Vector2d high = low.array() + layout.cell_m();
    if (layout.shows(low) && layout.shows(high)) {
      const Vector2d a = layout.pixel(low), b = layout.pixel(high);
      const Eigen::Vector2i first = a.cwiseMin(b).array().round().cast<int>();
      const Eigen::Vector2i last = a.cwiseMax(b).array().round().cast<int>();
      const double solid = 1.0 - std::exp(-static_cast<double>(column.solid_m) / kWallM);
      raster.fill(first.x(), first.y(), last.x(), last.y(),
                  io::mix(kBackground, heights.colour(static_cast<double>(column.top_m)),
                          kDim + (1.0 - kDim) * solid));
    }
  }
  return raster;
}

void draw_line_of_path(Picture& picture, const std::vector<Vector2d>& pixels, double end_radius) {
  picture.line(pixels, 3.0, kPath);
  if (pixels.empty()) return;
  for (const auto& [end, colour] : {std::pair(pixels.front(), kStart), {pixels.back(), kPath}}) {
    picture.disc(end, end_radius + 3.0, kBackground);
    picture.disc(end, end_radius, colour);
  }
}

void draw_path(Picture& picture, const Layout& layout, const std::vector<Eigen::Vector3d>& path) {
  std::vector<Vector2d> pixels;
  for (const Eigen::Vector3d& place : path) pixels.push_back(layout.pixel(place.head<2>()));
  draw_line_of_path(picture, pixels, 12.0);
}

SideView side_of(const Layout& layout, const std::vector<Eigen::Vector3f>& points) {
  std::vector<Vector2d> seen;
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d p = point.cast<double>();
    if (layout.shows(p.head<2>())) seen.emplace_back(layout.pixel(p.head<2>()).x(), p.z());
  }
  return SideView(seen, layout.pixels_per_m());
}

/// The map from the side with its path, from this row of the picture on.
void draw_side(Picture& picture, const Layout& layout, const SideView& side,
               const HeightRange& heights, const std::vector<Eigen::Vector3d>& path, int top) {
  const auto colour = [&](double height_m) { return heights.colour(height_m); };
  picture.paste(side.draw(kWidth, layout.cell_m() * layout.pixels_per_m(), kBackground, colour), 0,
                top);
  std::vector<Vector2d> pixels;
  for (const Eigen::Vector3d& place : path)
    pixels.emplace_back(layout.pixel(place.head<2>()).x(), top + side.row(place.z()));
  draw_line_of_path(picture, pixels, 5.0);
  const auto label = [&](double row, double height_m) {
    picture.text({kMargin / 4.0, row}, fmt::format("{:.1f} m", height_m), 0.7 * kTextSize, kInk);
  };
  label(top + kTextSize, side.high_m());
  label(top + side.height(), side.low_m());
}

/// The longest of 1, 2, 5, 10, ... that is no longer than limit.
double round_length(double limit) {
  const double power = std::pow(10.0, std::floor(std::log10(limit)));
  return power * (limit >= 5.0 * power ? 5.0 : limit >= 2.0 * power ? 2.0 : 1.0);
}

void draw_scale_bar(Picture& picture, const Layout& layout, double left, double y) {
  const double length_m = round_length(180.0 / layout.pixels_per_m());
  const double right = left + length_m * layout.pixels_per_m();
  picture.line({{left, y}, {right, y}}, 2.0, kInk);
  picture.line({{left, y - 5.0}, {left, y + 5.0}}, 2.0, kInk);
  picture.line({{right, y - 5.0}, {right, y + 5.0}}, 2.0, kInk);
  picture.text({right + 12.0, y + kHalfDigit}, fmt::format("{:g} m", length_m), kTextSize, kInk);
}

void draw_mark(Picture& picture, double x, double y, io::Rgb colour, const char* name) {
  picture.disc({x, y}, 12.0, colour);
  picture.text({x + 14.0, y + kHalfDigit}, name, kTextSize, kInk);
}

void draw_axes(Picture& picture, const Layout& layout, const Vector2d& centre) {
  constexpr double kLength = 30.0;
  const Vector2d zero = layout.pixel(Vector2d::Zero());
  const Vector2d x = (layout.pixel(Vector2d::UnitX()) - zero).normalized();
  const Vector2d y = (layout.pixel(Vector2d::UnitY()) - zero).normalized();
  const Vector2d origin = centre - 0.5 * kLength * (x + y);
  for (const auto& [along, name] : {std::pair(x, "x"), std::pair(y, "y")}) {
    const Vector2d tip = origin + kLength * along;
    picture.line({origin, tip}, 2.0, kInk);
    picture.text(tip + 12.0 * along + Vector2d(0.0, kHalfDigit - 2.0), name, kTextSize, kInk,
                 TextAnchor::kCentre);
  }
}

Raster colour_bar() {
  constexpr int kLength = 160, kThick = 10;
  Raster bar(kLength, kThick, kBackground);
  for (int x = 0; x < kLength; ++x) {
    bar.fill(x, 0, x + 1, kThick, io::viridis(static_cast<double>(x) / (kLength - 1)));
  }
  return bar;
}

void draw_height_legend(Picture& picture, const HeightRange& heights, double right, double y) {
  constexpr double kGap = 12.0;
  const double text_y = y + kHalfDigit;
  right -= kGap + picture.text({right, text_y}, fmt::format("{:.1f} m", heights.high_m), kTextSize,
                               kInk, TextAnchor::kRight);
  const Raster bar = colour_bar();
  right -= bar.width;
  picture.paste(bar, static_cast<int>(right), static_cast<int>(y) - bar.height / 2);
  picture.text({right - kGap, text_y}, fmt::format("height {:.1f}", heights.low_m), kTextSize, kInk,
               TextAnchor::kRight);
}

}  // namespace

Picture draw_map(const std::vector<Eigen::Vector3f>& points,
                 const std::vector<Eigen::Vector3d>& path, double resolution_m) {
  const Layout layout(extent(points, path), resolution_m);
  const std::vector<MapColumn> columns = map_columns(points, layout.cell_m(), resolution_m);
  const HeightRange heights = height_range(columns);
  const SideView side = side_of(layout, points);
  const int side_top = layout.bottom() + kMargin / 2;
  Picture picture(kWidth, side_top + side.height() + kFooter, kBackground);
  picture.paste(draw_columns(layout, columns, heights), 0, 0);
  draw_path(picture, layout, path);
  draw_side(picture, layout, side, heights, path, side_top);
  const int y = picture.height() - kFooter / 2;
  draw_scale_bar(picture, layout, kMargin, y);
  draw_axes(picture, layout, {0.25 * kWidth, static_cast<double>(y)});
  draw_height_legend(picture, heights, picture.width() - kMargin, y);
  if (!path.empty()) {
    draw_mark(picture, 0.42 * kWidth, y, kStart, "start");
    draw_mark(picture, 0.42 * kWidth + 110.0, y, kPath, "end");
  }
  return picture;
}

}  // namespace voxlist::drawing
