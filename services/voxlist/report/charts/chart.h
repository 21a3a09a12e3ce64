#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace voxlist::desk {

/// What a mark stands for; the page's style sheet gives it its colours.
enum class Ink { kOurs, kPaper, kSecond, kThird, kMap, kFaint };

/// The class of the style sheet.
std::string css_of(Ink ink);

/// Lowest and highest value of an axis.
struct Range {
  double low = 0.0, high = 1.0;
};

/// How values lie along an axis. Logarithmic ones show values above 0 alone.
enum class Scale { kLinear, kLog };

/// One axis of a chart.
struct Axis {
  std::string label{};                        ///< with its unit
  std::optional<Range> range = std::nullopt;  ///< else that of what is drawn
  Scale scale = Scale::kLinear;
  std::vector<double> ticks{};  ///< else round values
};

/// What stands around a chart.
struct ChartFrame {
  std::string title;
  Axis x, y;
  double width = 420.0, height = 300.0;  ///< pixels
  bool equal_scale = false;              ///< one unit is as long on both axes, as a plan needs
};

/// A bar from the axis up.
struct Bar {
  double low, high, height;
};

/// A square of a plan, in the chart's units, and how dark it is, 0..1.
struct Cell {
  Eigen::Vector2d low;
  double share;
};

/// A chart as SVG: lines, bars, dots and cells over two axes, with a legend of what has a name.
/// What was added first lies lowest. Values that are not finite are left out.
class Chart {
 public:
  explicit Chart(ChartFrame frame) : frame_(std::move(frame)) {}

  Chart& line(const std::string& name, Ink ink, std::vector<Eigen::Vector2d> points);
  Chart& dashes(const std::string& name, Ink ink, std::vector<Eigen::Vector2d> points);
  Chart& dots(const std::string& name, Ink ink, std::vector<Eigen::Vector2d> points,
              double diameter_px);
  Chart& crosses(const std::string& name, Ink ink, std::vector<Eigen::Vector2d> points);
  Chart& bars(const std::string& name, Ink ink, std::vector<Bar> bars);
  Chart& cells(const std::string& name, Ink ink, std::vector<Cell> cells, double edge);

  /// Outlines of squares.
  Chart& frames(const std::string& name, Ink ink, std::vector<Eigen::Vector2d> lows, double edge);

  /// A value of one axis as a dashed line across the chart: the paper's beside ours.
  Chart& mark_x(const std::string& name, Ink ink, double value);
  Chart& mark_y(const std::string& name, Ink ink, double value);

  std::string svg() const;

 private:
  friend class ChartDrawing;
  enum class Kind { kLine, kDashes, kDots, kCrosses, kBars, kCells, kFrames, kMarkX, kMarkY };
  struct Layer {
    Kind kind;
    std::string name;
    Ink ink;
    std::vector<Eigen::Vector2d> points{};
    std::vector<Bar> bars{};
    std::vector<double> shares{};
    double size = 0.0;
  };

  Chart& add(Layer layer);

  ChartFrame frame_;
  std::vector<Layer> layers_;
};

}  // namespace voxlist::desk
