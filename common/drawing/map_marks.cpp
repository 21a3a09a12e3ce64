#include "voxlist/drawing/map_marks.h"

#include <fmt/core.h>

#include <cmath>
#include <utility>

namespace voxlist::drawing {
namespace {

using Eigen::Vector2d;

/// The longest of 1, 2, 5, 10, ... that is no longer than limit.
double round_length(double limit) {
  const double power = std::pow(10.0, std::floor(std::log10(limit)));
  return power * (limit >= 5.0 * power ? 5.0 : limit >= 2.0 * power ? 2.0 : 1.0);
}

}  // namespace

void draw_path(Picture& picture, const std::vector<Vector2d>& pixels, double end_radius) {
  picture.line(pixels, 3.0, kPath);
  if (pixels.empty()) return;
  for (const auto& [end, colour] : {std::pair(pixels.front(), kStart), {pixels.back(), kPath}}) {
    picture.disc(end, end_radius + 3.0, kUnknown);
    picture.disc(end, end_radius, colour);
  }
}

void draw_path(Picture& picture, const MapLayout& layout,
               const std::vector<Eigen::Vector3d>& path) {
  std::vector<Vector2d> pixels;
  for (const Eigen::Vector3d& place : path) pixels.push_back(layout.pixel(place.head<2>()));
  draw_path(picture, pixels, 12.0);
}

void draw_scale_bar(Picture& picture, const MapLayout& layout, double left, double y) {
  const double length_m = round_length(180.0 / layout.pixels_per_m());
  const double right = left + length_m * layout.pixels_per_m();
  picture.line({{left, y}, {right, y}}, 2.0, kInk);
  picture.line({{left, y - 5.0}, {left, y + 5.0}}, 2.0, kInk);
  picture.line({{right, y - 5.0}, {right, y + 5.0}}, 2.0, kInk);
  picture.text({right + 12.0, y + kHalfDigit}, fmt::format("{:g} m", length_m), kTextSize, kInk);
}

double draw_mark(Picture& picture, double x, double y, io::Rgb colour, const char* name) {
  picture.disc({x, y}, 12.0, colour);
  return x + 14.0 + picture.text({x + 14.0, y + kHalfDigit}, name, kTextSize, kInk);
}

void draw_axes(Picture& picture, const MapLayout& layout, const Vector2d& centre) {
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

void fill_square(Raster& raster, const MapLayout& layout, const Vector2d& centre, double edge_m,
                 io::Rgb colour) {
  const Vector2d low = centre.array() - 0.5 * edge_m, high = low.array() + edge_m;
  if (!layout.shows(low) || !layout.shows(high)) return;
  const Vector2d a = layout.pixel(low), b = layout.pixel(high);
  const Eigen::Vector2i first = a.cwiseMin(b).array().round().cast<int>();
  const Eigen::Vector2i last = a.cwiseMax(b).array().round().cast<int>();
  raster.fill(first.x(), first.y(), last.x(), last.y(), colour);
}

}  // namespace voxlist::drawing
