#include "voxlist/drawing/slice_picture.h"

#include <algorithm>

#include "voxlist/drawing/map_layout.h"
#include "voxlist/drawing/map_marks.h"

namespace voxlist::drawing {
namespace {

constexpr int kMargin = MapLayout::kMargin, kWidth = MapLayout::kWidth;
constexpr int kTitle = 36;  // rows above a slice
constexpr io::Rgb kOccupied{250, 214, 92};

// The piece of the floor plan that holds all of them.
PlanBox extent_of(const std::vector<MapSlice>& slices) {
  std::vector<Eigen::Vector3f> all;
  std::vector<Eigen::Vector3d> path;
  for (const MapSlice& slice : slices) {
    all.insert(all.end(), slice.view.occupied.begin(), slice.view.occupied.end());
    path.insert(path.end(), slice.view.path.begin(), slice.view.path.end());
  }
  return extent(all, path);
}

Raster plan_of(const MapSlice& slice, const MapLayout& layout, int width) {
  const MapView& view = slice.view;
  Raster plan(width, layout.bottom(), kUnknown);
  for (const Eigen::Vector2f& centre : view.free)
    fill_square(plan, layout, centre.cast<double>(), view.free_m, kFree);
  for (const Eigen::Vector2f& centre : slice.blocked)
    fill_square(plan, layout, centre.cast<double>(), view.free_m, kOccupied);
  // No voxel is thinner than a pixel.
  const double edge_m = std::max(view.resolution_m, 1.5 / layout.pixels_per_m());
  for (const Eigen::Vector3f& centre : view.occupied)
    fill_square(plan, layout, centre.head<2>().cast<double>(), edge_m, kOccupied);
  return plan;
}

void draw_footer(Picture& picture, const MapLayout& layout) {
  constexpr double kGap = 34.0;
  const double y = picture.height() - 0.5 * kFooter;
  draw_scale_bar(picture, layout, kMargin, y);
  draw_axes(picture, layout, {0.25 * kWidth, y});
  double x = 0.36 * kWidth;
  x = draw_mark(picture, x, y, kOccupied, "occupied") + kGap;
  x = draw_mark(picture, x, y, kFree, "free") + kGap;
  picture.text({x, y + kHalfDigit}, "black: unknown", kTextSize, kInk);
}

}  // namespace

Picture draw_slices(const std::vector<MapSlice>& slices) {
  const int width = kWidth / static_cast<int>(slices.size());
  const MapLayout layout(extent_of(slices), slices.front().view.resolution_m, width - 2 * kMargin);
  Picture picture(kWidth, kTitle + layout.bottom() + kFooter, kUnknown);
  int left = 0;
  for (const MapSlice& slice : slices) {
    Picture plan(width, layout.bottom(), kUnknown);
    plan.paste(plan_of(slice, layout, width), 0, 0);
    draw_path(plan, layout, slice.view.path);
    picture.paste(plan, left, kTitle);
    picture.text({left + kMargin, kTitle}, slice.title, kTextSize, kInk);
    left += width;
  }
  draw_footer(picture, layout);
  return picture;
}

}  // namespace voxlist::drawing
