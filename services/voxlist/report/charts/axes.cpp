#include "services/voxlist/report/charts/axes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "voxlist/drawing/plot.h"

namespace voxlist::desk {
namespace {

using Eigen::Vector2d;

constexpr double kLeft = 54.0, kRight = 14.0, kBottom = 44.0;  // pixels

const Axis& axis_of(const ChartFrame& frame, int axis) { return axis == 0 ? frame.x : frame.y; }

// A margin, so that nothing lies on the frame; bars and counts stand on 0.
Range fitted(const Axis& axis, double low, double high) {
  if (axis.range) return *axis.range;
  if (!std::isfinite(low) || !std::isfinite(high)) return {0.0, 1.0};
  if (axis.scale == Scale::kLog) return {low / 1.3, high * 1.3};
  const double span = high > low ? high - low : std::max(1e-3, std::abs(low));
  return {low >= 0.0 && low < 0.2 * span ? std::min(0.0, low) : low - 0.05 * span,
          high + 0.05 * span};
}

std::string told(double value) {
  const double size = std::abs(value);
  if (size >= 1e4 && size < 1e6) return fmt::format("{:g} k", value / 1e3);
  if (size >= 1e6 && size < 1e9) return fmt::format("{:g} M", value / 1e6);
  if (size >= 1e9 && size < 1e12) return fmt::format("{:g} G", value / 1e9);
  return fmt::format("{:.4g}", value);
}

}  // namespace

ChartAxes::ChartAxes(const ChartFrame& frame, const Vector2d& low, const Vector2d& high, double top)
    : frame_(frame),
      shown_{fitted(frame.x, low.x(), high.x()), fitted(frame.y, low.y(), high.y())},
      corner_(kLeft, top),
      size_(frame.width - kLeft - kRight, frame.height - top - kBottom) {
  if (frame.equal_scale) widen();
}

// The axis that would be drawn larger shows more.
void ChartAxes::widen() {
  const Vector2d span = high() - low();
  const double unit = span.cwiseQuotient(size_).maxCoeff();
  for (int axis = 0; axis < 2; ++axis) {
    const double more = (size_[axis] * unit - span[axis]) / 2.0;
    Range& range = shown_[static_cast<std::size_t>(axis)];
    range = {range.low - more, range.high + more};
  }
}

double ChartAxes::share(int axis, double value) const {
  const Range& range = shown_[static_cast<std::size_t>(axis)];
  if (axis_of(frame_, axis).scale == Scale::kLinear)
    return (value - range.low) / (range.high - range.low);
  return value > 0.0 ? std::log(value / range.low) / std::log(range.high / range.low) : NAN;
}

Vector2d ChartAxes::pixel(const Vector2d& value) const {
  return corner_ +
         Vector2d(share(0, value.x()) * size_.x(), (1.0 - share(1, value.y())) * size_.y());
}

Vector2d ChartAxes::pixels(double edge) const {
  return Vector2d::Constant(edge).cwiseQuotient(high() - low()).cwiseProduct(size_);
}

std::vector<double> ChartAxes::ticks(int axis) const {
  const Axis& named = axis_of(frame_, axis);
  const Range& range = shown_[static_cast<std::size_t>(axis)];
  std::vector<double> ticks = named.ticks;
  if (ticks.empty() && named.scale == Scale::kLinear)
    return drawing::plot_ticks(
        range.low, range.high,
        std::max(2, static_cast<int>(size_[axis] / (axis == 0 ? 62.0 : 42.0))));
  if (ticks.empty())
    for (double tick = std::pow(10.0, std::ceil(std::log10(range.low))); tick <= range.high;
         tick *= 10.0)
      ticks.push_back(tick);
  std::erase_if(ticks, [&](double tick) { return tick < range.low || tick > range.high; });
  return ticks;
}

void ChartAxes::draw(Svg& svg) const {
  const Vector2d end = corner_ + size_;
  for (const double x : ticks(0)) {
    const double at = pixel({x, high().y()}).x();
    svg.line({{at, corner_.y()}, {at, end.y()}}, "grid");
    svg.text({at, end.y() + 15.0}, told(x), "tick", "middle");
  }
  for (const double y : ticks(1)) {
    const double at = pixel({high().x(), y}).y();
    svg.line({{corner_.x(), at}, {end.x(), at}}, "grid");
    svg.text({corner_.x() - 6.0, at + 4.0}, told(y), "tick", "end");
  }
  svg.line({corner_, {corner_.x(), end.y()}, end}, "axis");
  svg.text({corner_.x() + size_.x() / 2.0, end.y() + 34.0}, frame_.x.label, "label", "middle");
  svg.text({4.0, corner_.y() - 8.0}, frame_.y.label, "label");
}

}  // namespace voxlist::desk
