#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string_view>
#include <vector>

#include "voxlist/io/clouds/colour.h"

namespace voxlist::drawing {

/// Where on a text the given point lies.
enum class TextAnchor { kLeft, kCentre, kRight };

/// An RGB image to draw on. Pixel (0, 0) is at the top left, x right, y down; a pixel's centre has
/// whole coordinates. What lies outside is not drawn. Lines, discs and text have smooth edges.
class Picture {
 public:
  Picture(int width, int height, io::Rgb background);

  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<io::Rgb>& pixels() const { return pixels_; }  ///< row after row

  /// The pixel's colour; it must lie inside.
  io::Rgb at(int x, int y) const;

  /// Sets a pixel, or mixes a share (0..1) of the colour into it.
  void set(int x, int y, io::Rgb colour, double share = 1.0);

  /// Fills the rectangle of these pixels, x from left to right - 1, y from top to bottom - 1.
  void fill(int left, int top, int right, int bottom, io::Rgb colour, double share = 1.0);

  /// A line of this width (pixels) with round ends; a disc of this diameter where both ends are the
  /// same.
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width, io::Rgb colour);
  void disc(const Eigen::Vector2d& centre, double diameter, io::Rgb colour) {
    line(centre, centre, diameter, colour);
  }

  /// One line of text whose digits are `size` pixels high and stand on the anchor's y. Letters are
  /// drawn lower case; signs that the font lacks are left blank.
  void text(const Eigen::Vector2d& anchor, std::string_view words, double size, io::Rgb colour,
            TextAnchor side = TextAnchor::kLeft);

  /// Copies another picture to (left, top).
  void paste(const Picture& other, int left, int top);

 private:
  int width_;
  int height_;
  std::vector<io::Rgb> pixels_;
};

/// Width of a text in pixels as Picture::text draws it.
double text_width(std::string_view words, double size);

/// Writes the picture as PNG, atomically. Throws FileError.
void write_png(const std::filesystem::path& path, const Picture& picture);

}  // namespace voxlist::drawing
