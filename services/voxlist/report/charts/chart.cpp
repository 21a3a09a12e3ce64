#include "services/voxlist/report/charts/chart.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "services/voxlist/report/charts/axes.h"
#include "services/voxlist/report/charts/svg.h"

namespace voxlist::desk {

using Eigen::Vector2d;

namespace {

constexpr double kTitle = 16.0, kLegendLine = 16.0;  // pixels, as everything here
constexpr double kLetter = 6.1;  // of the small text, in the mean: SVG text is not measured here
constexpr std::size_t kShades = 8;

}  // namespace

/// A chart on its way to SVG.
class ChartDrawing {
 public:
  explicit ChartDrawing(const Chart& chart)
      : chart_(chart),
        svg_(chart.frame_.width, chart.frame_.height, chart.frame_.title),
        top_(draw_head()),
        axes_(chart.frame_, bounds().first, bounds().second, top_) {}

  std::string finish() {
    axes_.draw(svg_);
    for (const Chart::Layer& layer : chart_.layers_) draw(layer);
    return svg_.finish();
  }

 private:
  using Kind = Chart::Kind;

  // Title and legend; returns where the axes begin.
  double draw_head() {
    svg_.text({4.0, kTitle}, chart_.frame_.title, "title");
    double x = 6.0, y = kTitle + 18.0;
    bool any = false;
    for (const Chart::Layer& layer : chart_.layers_) {
      if (layer.name.empty()) continue;
      const double width = 24.0 + kLetter * static_cast<double>(layer.name.size());
      if (any && x + width > chart_.frame_.width) {
        x = 6.0;
        y += kLegendLine;
      }
      draw_key(layer, {x, y - 4.0});
      svg_.text({x + 20.0, y}, layer.name, "tick");
      x += width + 8.0;
      any = true;
    }
    return (any ? y : kTitle) + 26.0;
  }

  void draw_key(const Chart::Layer& layer, const Vector2d& at) {
    const std::string css = css_of(layer.ink);
    const Vector2d right = at + Vector2d(15.0, 0.0), middle = at + Vector2d(8.0, 0.0);
    switch (layer.kind) {
      case Kind::kLine:
        return svg_.line({at, right}, css);
      case Kind::kDots:
        return svg_.dots({middle}, 6.0, css);
      case Kind::kCrosses:
        return draw_crosses({middle}, css);
      case Kind::kBars:
      case Kind::kCells:
        return svg_.box(at + Vector2d(2.0, -4.0), at + Vector2d(13.0, 5.0), "fill bar " + css);
      case Kind::kFrames:
        return svg_.box(at + Vector2d(2.0, -4.0), at + Vector2d(12.0, 5.0), "frame " + css);
      default:
        return svg_.line({at, right}, "dashed " + css);
    }
  }

  std::pair<Vector2d, Vector2d> bounds() const {
    Vector2d low = Vector2d::Constant(HUGE_VAL), high = -low;
    const auto take = [&](const Vector2d& value) {
      for (int axis = 0; axis < 2; ++axis) {
        const auto& named = axis == 0 ? chart_.frame_.x : chart_.frame_.y;
        if (!std::isfinite(value[axis])) continue;
        if (named.scale == Scale::kLog && value[axis] <= 0.0) continue;
        low[axis] = std::min(low[axis], value[axis]);
        high[axis] = std::max(high[axis], value[axis]);
      }
    };
    for (const Chart::Layer& layer : chart_.layers_) {
      const bool squares = layer.kind == Kind::kCells || layer.kind == Kind::kFrames;
      for (const Vector2d& point : layer.points) {
        take(point);
        if (squares) take(point + Vector2d::Constant(layer.size));
      }
      for (const Bar& bar : layer.bars) {
        take({bar.low, 0.0});
        take({bar.high, bar.height});
      }
      if (layer.kind == Kind::kMarkX) take({layer.size, NAN});
      if (layer.kind == Kind::kMarkY) take({NAN, layer.size});
    }
    return {low, high};
  }

  std::vector<Vector2d> pixels(const std::vector<Vector2d>& values) const {
    std::vector<Vector2d> found;
    found.reserve(values.size());
    for (const Vector2d& value : values) found.push_back(axes_.pixel(value));
    return found;
  }

  // What lies beyond the axes is left out.
  std::vector<Vector2d> inside(const std::vector<Vector2d>& values, double edge = 0.0) const {
    std::vector<Vector2d> kept;
    for (const Vector2d& value : values)
      if ((value.array() >= axes_.low().array()).all() &&
          (value.array() + edge <= axes_.high().array()).all())
        kept.push_back(value);
    return kept;
  }

  // A line as far as the axes show it: it ends where it leaves them.
  std::vector<Vector2d> cut(const std::vector<Vector2d>& points) const {
    std::vector<Vector2d> kept;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const auto part = part_inside(points[i], points[i + 1]);
      if (!part) {
        kept.emplace_back(NAN, NAN);
        continue;
      }
      if (kept.empty() || kept.back() != part->first) kept.push_back(part->first);
      kept.push_back(part->second);
      if (part->second != points[i + 1]) kept.emplace_back(NAN, NAN);
    }
    return kept;
  }

  // Liang and Barsky's way of cutting a straight line at a rectangle; of values, where a
  // logarithmic axis bends it by less than anybody sees.
  std::optional<std::pair<Vector2d, Vector2d>> part_inside(const Vector2d& from,
                                                           const Vector2d& to) const {
    if (!from.allFinite() || !to.allFinite()) return std::nullopt;
    const Vector2d way = to - from;
    double first = 0.0, last = 1.0;
    for (int axis = 0; axis < 2; ++axis) {
      const double low = axes_.low()[axis] - from[axis], high = axes_.high()[axis] - from[axis];
      if (way[axis] == 0.0) {
        if (low > 0.0 || high < 0.0) return std::nullopt;
        continue;
      }
      first = std::max(first, std::min(low / way[axis], high / way[axis]));
      last = std::min(last, std::max(low / way[axis], high / way[axis]));
    }
    if (first > last) return std::nullopt;
    return std::pair(first == 0.0 ? from : Vector2d(from + first * way),
                     last == 1.0 ? to : Vector2d(from + last * way));
  }

  void draw(const Chart::Layer& layer) {
    const std::string css = css_of(layer.ink);
    switch (layer.kind) {
      case Kind::kLine:
        return svg_.line(pixels(cut(layer.points)), css);
      case Kind::kDashes:
        return svg_.line(pixels(cut(layer.points)), "dashed " + css);
      case Kind::kDots:
        return svg_.dots(pixels(inside(layer.points)), layer.size, css);
      case Kind::kCrosses:
        return draw_crosses(pixels(inside(layer.points)), css);
      case Kind::kBars:
        return draw_bars(layer, css);
      case Kind::kCells:
        return draw_cells(layer, css);
      case Kind::kFrames:
        return draw_frames(layer, css);
      case Kind::kMarkX:
        return draw_mark(layer, 0, css);
      case Kind::kMarkY:
        return draw_mark(layer, 1, css);
    }
  }

  void draw_crosses(const std::vector<Vector2d>& centres, const std::string& css) {
    std::vector<Vector2d> strokes;
    for (const Vector2d& at : centres)
      for (const Vector2d& arm : {Vector2d(2.5, 2.5), Vector2d(2.5, -2.5)}) {
        strokes.push_back(at - arm);
        strokes.push_back(at + arm);
        strokes.emplace_back(NAN, NAN);
      }
    svg_.line(strokes, "thin " + css);
  }

  void draw_bars(const Chart::Layer& layer, const std::string& css) {
    for (const Bar& bar : layer.bars) {
      if (bar.low < axes_.low().x() || bar.high > axes_.high().x() || bar.height <= 0.0) continue;
      svg_.box(axes_.pixel({bar.low, std::max(0.0, axes_.low().y())}),
               axes_.pixel({bar.high, std::min(bar.height, axes_.high().y())}), "fill bar " + css);
    }
  }

  // One path a shade.
  void draw_cells(const Chart::Layer& layer, const std::string& css) {
    std::array<std::vector<Vector2d>, kShades> shades;
    const Vector2d size = axes_.pixels(layer.size);
    for (std::size_t i = 0; i < layer.points.size(); ++i) {
      const double share = std::clamp(layer.shares[i], 0.0, 1.0);
      const auto shade = std::min(kShades - 1, static_cast<std::size_t>(share * kShades));
      if (inside({layer.points[i]}, layer.size).empty()) continue;
      shades[shade].push_back(axes_.pixel(layer.points[i]) - Vector2d(0.0, size.y()));
    }
    for (std::size_t shade = 0; shade < kShades; ++shade)
      svg_.boxes(shades[shade], size, fmt::format("shade{} {}", shade + 1, css));
  }

  void draw_frames(const Chart::Layer& layer, const std::string& css) {
    for (const Vector2d& low : inside(layer.points, layer.size))
      svg_.box(axes_.pixel(low), axes_.pixel(low + Vector2d::Constant(layer.size)), "frame " + css);
  }

  void draw_mark(const Chart::Layer& layer, int axis, const std::string& css) {
    Vector2d from = axes_.low(), to = axes_.high();
    from[axis] = to[axis] = layer.size;
    if (layer.size < axes_.low()[axis] || layer.size > axes_.high()[axis]) return;
    svg_.line({axes_.pixel(from), axes_.pixel(to)}, "dashed " + css);
  }

  const Chart& chart_;
  Svg svg_;
  const double top_;
  const ChartAxes axes_;
};

std::string css_of(Ink ink) {
  constexpr std::array kNames{"ours", "paper", "second", "third", "map", "faint"};
  return kNames[static_cast<std::size_t>(ink)];
}

Chart& Chart::add(Layer layer) {
  layers_.push_back(std::move(layer));
  return *this;
}

Chart& Chart::line(const std::string& name, Ink ink, std::vector<Vector2d> points) {
  return add({Kind::kLine, name, ink, std::move(points)});
}

Chart& Chart::dashes(const std::string& name, Ink ink, std::vector<Vector2d> points) {
  return add({Kind::kDashes, name, ink, std::move(points)});
}

Chart& Chart::dots(const std::string& name, Ink ink, std::vector<Vector2d> points,
                   double diameter_px) {
  return add({Kind::kDots, name, ink, std::move(points), {}, {}, diameter_px});
}

Chart& Chart::crosses(const std::string& name, Ink ink, std::vector<Vector2d> points) {
  return add({Kind::kCrosses, name, ink, std::move(points)});
}

Chart& Chart::bars(const std::string& name, Ink ink, std::vector<Bar> bars) {
  return add({Kind::kBars, name, ink, {}, std::move(bars)});
}

Chart& Chart::cells(const std::string& name, Ink ink, std::vector<Cell> cells, double edge) {
  Layer layer{Kind::kCells, name, ink, {}, {}, {}, edge};
  for (const Cell& cell : cells) {
    layer.points.push_back(cell.low);
    layer.shares.push_back(cell.share);
  }
  return add(std::move(layer));
}

Chart& Chart::frames(const std::string& name, Ink ink, std::vector<Vector2d> lows, double edge) {
  return add({Kind::kFrames, name, ink, std::move(lows), {}, {}, edge});
}

Chart& Chart::mark_x(const std::string& name, Ink ink, double value) {
  return add({Kind::kMarkX, name, ink, {}, {}, {}, value});
}

Chart& Chart::mark_y(const std::string& name, Ink ink, double value) {
  return add({Kind::kMarkY, name, ink, {}, {}, {}, value});
}

std::string Chart::svg() const { return ChartDrawing(*this).finish(); }

}  // namespace voxlist::desk
