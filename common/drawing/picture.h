#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "voxlist/drawing/raster.h"

namespace voxlist::drawing {

/// Where the given point lies on a text.
enum class TextAnchor { kLeft, kCentre, kRight };

/// A page of lines, text and images, in pixels: x to the right, y down, whole coordinates at the
/// centres of pixels, (0, 0) at the top left. It keeps what was drawn as shapes, so that it can be
/// written as pixels or as vectors. Whatever lies outside the page is cut off.
class Picture {
 public:
  /// Sides of 1 to 20000 pixels; throws std::invalid_argument otherwise.
  Picture(int width, int height, io::Rgb background);
  Picture(Picture&&) noexcept;
  Picture& operator=(Picture&&) noexcept;
  ~Picture();

  int width() const { return width_; }
  int height() const { return height_; }

  /// Joins the points by a line of this width with round ends. The line is broken where a point is
  /// not finite or more than a million pixels away.
  void line(const std::vector<Eigen::Vector2d>& points, double width, io::Rgb colour);

  void disc(const Eigen::Vector2d& centre, double diameter, io::Rgb colour);

  /// Writes one line of text (UTF-8) in a font of `size` pixels; its baseline is at the anchor's y.
  /// Returns the text's width in pixels.
  double text(const Eigen::Vector2d& anchor, const std::string& words, double size, io::Rgb colour,
              TextAnchor side = TextAnchor::kLeft);

  /// Copies an image or another picture; its top left corner comes to this pixel.
  void paste(const Raster& image, int left, int top);
  void paste(const Picture& other, int left, int top);

  /// Writes the picture as PNG or as SVG, atomically. Throws io::FileError.
  void write_png(const std::filesystem::path& path) const;
  void write_svg(const std::filesystem::path& path) const;

 private:
  struct Page;

  int width_;
  int height_;
  std::unique_ptr<Page> page_;
};

}  // namespace voxlist::drawing
