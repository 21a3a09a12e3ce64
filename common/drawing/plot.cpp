#include "voxlist/drawing/plot.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace voxlist::drawing {
namespace {

using Eigen::Vector2d;

constexpr io::Rgb kPaper{255, 255, 255};
constexpr io::Rgb kInk{40, 44, 52};
constexpr io::Rgb kGrid{226, 228, 232};
constexpr double kTextSize = 14.0, kTitleSize = 18.0;  // pixels, as everything here
constexpr int kLeft = 70, kRight = 24, kTop = 52, kBottom = 56;

/// Takes values to pixels.
class Axes {
 public:
  Axes(const PlotFrame& frame, const std::vector<PlotSeries>& series) {
    size_ = {frame.width - kLeft - kRight, frame.height - kTop - kBottom};
    fit(series);
    if (frame.equal_scale) {
      const Vector2d scale = (high_ - low_).cwiseQuotient(size_);
      const Vector2d grow = (size_ * scale.maxCoeff() - (high_ - low_)) / 2.0;
      low_ -= grow;
      high_ += grow;
    }
  }

  const Vector2d& low() const { return low_; }
  const Vector2d& high() const { return high_; }

  Vector2d pixel(const Vector2d& value) const {
    const Vector2d share = (value - low_).cwiseQuotient(high_ - low_);
    return {kLeft + share.x() * size_.x(), kTop + (1.0 - share.y()) * size_.y()};
  }

 private:
  void fit(const std::vector<PlotSeries>& series) {
    low_.setConstant(HUGE_VAL);
    high_.setConstant(-HUGE_VAL);
    for (const PlotSeries& line : series) {
      for (const Vector2d& point : line.points) {
        if (point.allFinite()) {
          low_ = low_.cwiseMin(point);
          high_ = high_.cwiseMax(point);
        }
      }
    }
    if (!low_.allFinite()) {
      low_.setZero();
      high_.setOnes();
    }
    for (int axis = 0; axis < 2; ++axis) {
      const double span = high_[axis] - low_[axis];
      const double margin = span > 0.0 ? 0.04 * span : std::max(1e-3, 0.1 * std::abs(low_[axis]));
      low_[axis] -= margin;
      high_[axis] += margin;
    }
  }

  Vector2d size_, low_, high_;
};

// A line that lies between two rows of pixels would be two of them wide, and grey.
void draw_straight(Picture& picture, const Vector2d& from, const Vector2d& to, io::Rgb colour) {
  picture.line({from.array().round(), to.array().round()}, 1.0, colour);
}

void draw_grid(Picture& picture, const Axes& axes) {
  const Vector2d low = axes.low(), high = axes.high();
  for (const double x : plot_ticks(low.x(), high.x(), 8)) {
    const Vector2d foot = axes.pixel({x, low.y()});
    draw_straight(picture, foot, axes.pixel({x, high.y()}), kGrid);
    picture.text(foot + Vector2d(0.0, 20.0), fmt::format("{:g}", x), kTextSize, kInk,
                 TextAnchor::kCentre);
  }
  for (const double y : plot_ticks(low.y(), high.y(), 6)) {
    const Vector2d left = axes.pixel({low.x(), y});
    draw_straight(picture, left, axes.pixel({high.x(), y}), kGrid);
    picture.text(left + Vector2d(-8.0, 0.36 * kTextSize), fmt::format("{:g}", y), kTextSize, kInk,
                 TextAnchor::kRight);
  }
  draw_straight(picture, axes.pixel(low), axes.pixel({high.x(), low.y()}), kInk);
  draw_straight(picture, axes.pixel(low), axes.pixel({low.x(), high.y()}), kInk);
}

void draw_series(Picture& picture, const Axes& axes, const PlotSeries& series) {
  std::vector<Vector2d> pixels;
  for (const Vector2d& point : series.points) pixels.push_back(axes.pixel(point));
  picture.line(pixels, 2.0, series.colour);
  if (pixels.size() == 1) picture.disc(pixels.front(), 6.0, series.colour);
}

void draw_legend(Picture& picture, const std::vector<PlotSeries>& series) {
  double right = picture.width() - kRight;
  for (auto line = series.rbegin(); line != series.rend(); ++line) {
    right -= 10.0 + picture.text({right, 38.0}, line->name, kTextSize, kInk, TextAnchor::kRight);
    picture.line({{right - 20.0, 33.0}, {right, 33.0}}, 3.0, line->colour);
    right -= 44.0;
  }
}

}  // namespace

Picture draw_plot(const PlotFrame& frame, const std::vector<PlotSeries>& series) {
  Picture picture(frame.width, frame.height, kPaper);
  const Axes axes(frame, series);
  draw_grid(picture, axes);
  for (const PlotSeries& line : series) draw_series(picture, axes, line);
  draw_legend(picture, series);
  picture.text({kLeft, 20.0}, frame.title, kTitleSize, kInk);
  picture.text({kLeft, 42.0}, frame.y_label, kTextSize, kInk);
  picture.text({static_cast<double>(frame.width - kRight), frame.height - 12.0}, frame.x_label,
               kTextSize, kInk, TextAnchor::kRight);
  return picture;
}

std::vector<double> plot_ticks(double low, double high, int count) {
  const double rough = (high - low) / count;
  if (!(rough > 0.0) || !std::isfinite(rough)) {
    return {};
  }
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double ratio = rough / power;
  const double step = power * (ratio <= 1.0 ? 1.0 : ratio <= 2.0 ? 2.0 : ratio <= 5.0 ? 5.0 : 10.0);
  std::vector<double> ticks;
  const double first = std::ceil(low / step), last = std::floor(high / step);
  for (int i = 0; i <= 2 * count && first + i <= last; ++i) {
    ticks.push_back((first + i) * step);
  }
  return ticks;
}

}  // namespace voxlist::drawing
