#include "voxlist/drawing/picture.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "voxlist/drawing/stroke_font.h"

namespace voxlist::drawing {
namespace {

using Eigen::Vector2d;

double distance_to_segment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double squared = along.squaredNorm();
  const double share = squared > 0.0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (p - a - share * along).norm();
}

int clamp_to(double value, int limit) {
  return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(limit)));
}

}  // namespace

Picture::Picture(int width, int height, io::Rgb background) : width_(width), height_(height) {
  constexpr int kMaxSide = 20000;
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) {
    throw std::invalid_argument("Picture: sides of 1 to 20000 pixels are possible");
  }
  pixels_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), background);
}

io::Rgb Picture::at(int x, int y) const {
  return pixels_.at(static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(x));
}

void Picture::set(int x, int y, io::Rgb colour, double share) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) {
    return;
  }
  io::Rgb& pixel = pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                           static_cast<std::size_t>(x)];
  pixel = io::mix(pixel, colour, share);
}

void Picture::fill(int left, int top, int right, int bottom, io::Rgb colour, double share) {
  for (int y = std::max(top, 0); y < std::min(bottom, height_); ++y) {
    for (int x = std::max(left, 0); x < std::min(right, width_); ++x) {
      set(x, y, colour, share);
    }
  }
}

void Picture::line(const Vector2d& from, const Vector2d& to, double width, io::Rgb colour) {
  const double reach = width / 2.0 + 0.5;
  const Vector2d low = from.cwiseMin(to).array() - reach, high = from.cwiseMax(to).array() + reach;
  if (!low.allFinite() || !high.allFinite()) {
    return;
  }
  for (int y = clamp_to(std::floor(low.y()), height_); y < clamp_to(high.y() + 1.0, height_); ++y) {
    for (int x = clamp_to(std::floor(low.x()), width_); x < clamp_to(high.x() + 1.0, width_); ++x) {
      set(x, y, colour, reach - distance_to_segment({x, y}, from, to));
    }
  }
}

void Picture::text(const Vector2d& anchor, std::string_view words, double size, io::Rgb colour,
                   TextAnchor side) {
  const double unit = size / kGlyphBaseline;
  const double shift = side == TextAnchor::kLeft ? 0.0 : side == TextAnchor::kRight ? 1.0 : 0.5;
  Vector2d corner = anchor - Vector2d(shift * text_width(words, size), size);
  for (const char letter : words) {
    for (const GlyphStroke& stroke : glyph(letter)) {
      line(corner + unit * stroke.from, corner + unit * stroke.to, std::max(1.2, size / 7.0),
           colour);
    }
    corner.x() += unit * kGlyphAdvance;
  }
}

void Picture::paste(const Picture& other, int left, int top) {
  for (int y = 0; y < other.height(); ++y) {
    for (int x = 0; x < other.width(); ++x) {
      set(left + x, top + y, other.at(x, y));
    }
  }
}

double text_width(std::string_view words, double size) {
  const auto letters = static_cast<double>(words.size());
  return std::max(0.0, letters * kGlyphAdvance - (kGlyphAdvance - kGlyphWidth)) * size /
         kGlyphBaseline;
}

}  // namespace voxlist::drawing
