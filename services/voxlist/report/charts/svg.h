#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace voxlist::desk {

/// Text as it may stand in HTML, XML and their attributes.
std::string escaped(const std::string& text);

/// An SVG drawing in the making, as text to stand in a page whose style sheet knows the classes:
/// so it follows the page's light or dark colours. Pixels, x to the right, y down.
class Svg {
 public:
  /// `title`: what a screen reader says of it.
  Svg(double width, double height, const std::string& title);

  /// Joins the points; broken where one is not finite.
  void line(const std::vector<Eigen::Vector2d>& points, const std::string& css);

  /// Round dots, all of one diameter.
  void dots(const std::vector<Eigen::Vector2d>& centres, double diameter, const std::string& css);

  /// Rectangles of one size, by their top left corners.
  void boxes(const std::vector<Eigen::Vector2d>& corners, const Eigen::Vector2d& size,
             const std::string& css);

  /// One rectangle between two corners, whichever they are.
  void box(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const std::string& css);

  /// A line of text; `anchor`: start, middle or end.
  void text(const Eigen::Vector2d& at, const std::string& words, const std::string& css,
            const std::string& anchor = "start");

  std::string finish() const { return text_ + "</svg>\n"; }

 private:
  std::string text_;
};

}  // namespace voxlist::desk
