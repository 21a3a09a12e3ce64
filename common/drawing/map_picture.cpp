#include "voxlist/drawing/map_picture.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "voxlist/drawing/map_columns.h"
#include "voxlist/drawing/map_layout.h"
#include "voxlist/drawing/map_marks.h"
#include "voxlist/drawing/side_view.h"

namespace voxlist::drawing {
namespace {

using Eigen::Vector2d;

constexpr io::Rgb kBefore{120, 126, 136};
constexpr io::Rgb kLoop{255, 214, 64};
constexpr int kMargin = MapLayout::kMargin, kWidth = MapLayout::kWidth;

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

void draw_free(Raster& raster, const MapLayout& layout, const MapView& view) {
  for (const Eigen::Vector2f& centre : view.free)
    fill_square(raster, layout, centre.cast<double>(), view.free_m, kFree);
}

void draw_columns(Raster& raster, const MapLayout& layout, const std::vector<MapColumn>& columns,
                  const HeightRange& heights) {
  // A single layer has a little more than this share of its colour; so much above each other (m)
  // takes it two thirds of the way to the whole.
  constexpr double kDim = 0.55, kWallM = 0.5;
  for (const MapColumn& column : columns) {
    const double solid = 1.0 - std::exp(-static_cast<double>(column.solid_m) / kWallM);
    const Vector2d centre = (column.cell.cast<double>().array() + 0.5) * layout.cell_m();
    fill_square(raster, layout, centre, layout.cell_m(),
                io::mix(kUnknown, heights.colour(static_cast<double>(column.top_m)),
                        kDim + (1.0 - kDim) * solid));
  }
}

SideView side_of(const MapLayout& layout, const std::vector<Eigen::Vector3f>& points) {
  std::vector<Vector2d> seen;
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d p = point.cast<double>();
    if (layout.shows(p.head<2>())) seen.emplace_back(layout.pixel(p.head<2>()).x(), p.z());
  }
  return SideView(seen, layout.pixels_per_m());
}

/// The map from the side with its path, from this row of the picture on.
void draw_side(Picture& picture, const MapLayout& layout, const SideView& side,
               const HeightRange& heights, const std::vector<Eigen::Vector3d>& path, int top) {
  const auto colour = [&](double height_m) { return heights.colour(height_m); };
  picture.paste(side.draw(kWidth, layout.cell_m() * layout.pixels_per_m(), kUnknown, colour), 0,
                top);
  std::vector<Vector2d> pixels;
  for (const Eigen::Vector3d& place : path)
    pixels.emplace_back(layout.pixel(place.head<2>()).x(), top + side.row(place.z()));
  draw_path(picture, pixels, 5.0);
  const auto label = [&](double row, double height_m) {
    picture.text({kMargin / 4.0, row}, fmt::format("{:.1f} m", height_m), 0.7 * kTextSize, kInk);
  };
  label(top + kTextSize, side.high_m());
  label(top + side.height(), side.low_m());
}

Raster colour_bar() {
  constexpr int kLength = 160, kThick = 10;
  Raster bar(kLength, kThick, kUnknown);
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

void draw_before(Picture& picture, const MapLayout& layout, const ClosedLoops& closed) {
  std::vector<Vector2d> pixels;
  for (const Vector2d& place : closed.before) pixels.push_back(layout.pixel(place));
  picture.line(pixels, 1.5, kBefore);
}

void draw_loops(Picture& picture, const MapLayout& layout, const ClosedLoops& closed) {
  for (const auto& [from, to] : closed.loops) {
    picture.line({layout.pixel(from), layout.pixel(to)}, 2.0, kLoop);
    picture.disc(layout.pixel(from), 7.0, kLoop);
    picture.disc(layout.pixel(to), 7.0, kLoop);
  }
}

void draw_footer(Picture& picture, const MapLayout& layout, const MapView& view,
                 const HeightRange& heights) {
  constexpr double kGap = 34.0;
  const double y = picture.height() - 0.5 * kFooter;
  draw_scale_bar(picture, layout, kMargin, y);
  draw_axes(picture, layout, {0.25 * kWidth, y});
  draw_height_legend(picture, heights, picture.width() - kMargin, y);
  double x = 0.36 * kWidth;
  if (!view.path.empty()) {
    x = draw_mark(picture, x, y, kStart, "start") + kGap;
    x = draw_mark(picture, x, y, kPath, "end") + kGap;
  }
  if (!view.free.empty()) x = draw_mark(picture, x, y, kFree, "free") + kGap;
  if (!view.closed.loops.empty()) {
    x = draw_mark(picture, x, y, kLoop, "loops") + kGap;
    draw_mark(picture, x, y, kBefore, "before");
  }
}

}  // namespace

Picture draw_map(const MapView& view) {
  const MapLayout layout(extent(view.occupied, view.path), view.resolution_m);
  const std::vector<MapColumn> columns =
      map_columns(view.occupied, layout.cell_m(), view.resolution_m);
  const HeightRange heights = height_range(columns);
  const SideView side = side_of(layout, view.occupied);
  const int side_top = layout.bottom() + kMargin / 2;
  Raster plan(kWidth, layout.bottom(), kUnknown);
  draw_free(plan, layout, view);
  draw_columns(plan, layout, columns, heights);
  Picture picture(kWidth, side_top + side.height() + kFooter, kUnknown);
  picture.paste(plan, 0, 0);
  draw_before(picture, layout, view.closed);
  draw_path(picture, layout, view.path);
  draw_loops(picture, layout, view.closed);
  draw_side(picture, layout, side, heights, view.path, side_top);
  draw_footer(picture, layout, view, heights);
  return picture;
}

}  // namespace voxlist::drawing
