#include "voxlist/drawing/picture.h"

#include <cairo-svg.h>
#include <cairo.h>

#include <cstdint>
#include <new>
#include <numbers>
#include <stdexcept>

#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"

namespace voxlist::drawing {
namespace {

using Eigen::Vector2d;
using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

Surface owned(cairo_surface_t* surface) { return {surface, &cairo_surface_destroy}; }

Context drawing_on(const Surface& surface) { return {cairo_create(surface.get()), &cairo_destroy}; }

Surface recording(int width, int height) {
  const cairo_rectangle_t extents{0.0, 0.0, static_cast<double>(width),
                                  static_cast<double>(height)};
  return owned(cairo_recording_surface_create(CAIRO_CONTENT_COLOR, &extents));
}

// Letters keep their shapes and distances whatever the page is written as.
void choose_font(cairo_t* cairo) {
  cairo_select_font_face(cairo, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(cairo, options);
  cairo_font_options_destroy(options);
}

void choose_colour(cairo_t* cairo, io::Rgb colour) {
  cairo_set_source_rgb(cairo, colour.r / 255.0, colour.g / 255.0, colour.b / 255.0);
}

void paint(cairo_t* cairo, const Surface& source, double left, double top) {
  cairo_set_source_surface(cairo, source.get(), left, top);
  cairo_paint(cairo);
}

// Cairo's own coordinates end at 8 million.
bool can_be_drawn(const Vector2d& point) {
  constexpr double kFarPixels = 1e6;
  return point.allFinite() && point.cwiseAbs().maxCoeff() < kFarPixels;
}

Surface as_image(const Raster& raster) {
  Surface image =
      owned(cairo_image_surface_create(CAIRO_FORMAT_RGB24, raster.width, raster.height));
  unsigned char* row = cairo_image_surface_get_data(image.get());
  if (row == nullptr) throw std::bad_alloc();
  auto pixel = raster.pixels.begin();
  for (int y = 0; y < raster.height; ++y) {
    auto* const words = reinterpret_cast<std::uint32_t*>(row);
    for (int x = 0; x < raster.width; ++x, ++pixel) {
      words[x] = std::uint32_t{pixel->r} << 16 | std::uint32_t{pixel->g} << 8 | pixel->b;
    }
    row += cairo_image_surface_get_stride(image.get());
  }
  cairo_surface_mark_dirty(image.get());
  return image;
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int size) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

void check(cairo_status_t status, const std::filesystem::path& path) {
  if (status != CAIRO_STATUS_SUCCESS) {
    throw io::FileError(path, std::string("cannot be drawn: ") + cairo_status_to_string(status));
  }
}

}  // namespace

struct Picture::Page {
  Page(int width, int height) : surface(recording(width, height)), context(drawing_on(surface)) {}

  // Draws the page on another surface.
  void replay(const Surface& target, const std::filesystem::path& path) const {
    const Context cairo = drawing_on(target);
    paint(cairo.get(), surface, 0.0, 0.0);
    check(cairo_status(context.get()), path);
    check(cairo_status(cairo.get()), path);
  }

  Surface surface;
  Context context;
};

Picture::Picture(int width, int height, io::Rgb background) : width_(width), height_(height) {
  constexpr int kMaxSide = 20000;
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) {
    throw std::invalid_argument("Picture: sides of 1 to 20000 pixels are possible");
  }
  page_ = std::make_unique<Page>(width, height);
  cairo_t* const cairo = page_->context.get();
  choose_colour(cairo, background);
  cairo_paint(cairo);
  cairo_translate(cairo, 0.5, 0.5);  // cairo's whole coordinates are the corners of pixels
  cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  choose_font(cairo);
}

Picture::Picture(Picture&&) noexcept = default;
Picture& Picture::operator=(Picture&&) noexcept = default;
Picture::~Picture() = default;

void Picture::line(const std::vector<Vector2d>& points, double width, io::Rgb colour) {
  cairo_t* const cairo = page_->context.get();
  for (const Vector2d& point : points) {
    if (can_be_drawn(point)) {
      cairo_line_to(cairo, point.x(), point.y());  // begins a line where there is none
    } else {
      cairo_new_sub_path(cairo);
    }
  }
  choose_colour(cairo, colour);
  cairo_set_line_width(cairo, width);
  cairo_stroke(cairo);
}

void Picture::disc(const Vector2d& centre, double diameter, io::Rgb colour) {
  if (!can_be_drawn(centre)) return;
  cairo_t* const cairo = page_->context.get();
  cairo_arc(cairo, centre.x(), centre.y(), diameter / 2.0, 0.0, 2.0 * std::numbers::pi);
  choose_colour(cairo, colour);
  cairo_fill(cairo);
}

double Picture::text(const Vector2d& anchor, const std::string& words, double size, io::Rgb colour,
                     TextAnchor side) {
  cairo_t* const cairo = page_->context.get();
  cairo_set_font_size(cairo, size);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo, words.c_str(), &extents);
  const double width = extents.x_advance;
  const double before = side == TextAnchor::kLeft ? 0.0 : side == TextAnchor::kRight ? 1.0 : 0.5;
  cairo_move_to(cairo, anchor.x() - before * width, anchor.y());
  choose_colour(cairo, colour);
  cairo_show_text(cairo, words.c_str());
  cairo_new_path(cairo);  // the pen stays behind the text otherwise
  return width;
}

void Picture::paste(const Raster& image, int left, int top) {
  paint(page_->context.get(), as_image(image), left - 0.5, top - 0.5);
}

void Picture::paste(const Picture& other, int left, int top) {
  paint(page_->context.get(), other.page_->surface, left - 0.5, top - 0.5);
}

void Picture::write_png(const std::filesystem::path& path) const {
  const Surface image = owned(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_, height_));
  page_->replay(image, path);
  std::string bytes;
  check(cairo_surface_write_to_png_stream(image.get(), append, &bytes), path);
  io::write_file_atomically(path, bytes);
}

void Picture::write_svg(const std::filesystem::path& path) const {
  std::string bytes;
  const Surface svg = owned(cairo_svg_surface_create_for_stream(append, &bytes, width_, height_));
  cairo_svg_surface_set_document_unit(svg.get(), CAIRO_SVG_UNIT_PX);
  page_->replay(svg, path);
  cairo_surface_finish(svg.get());
  check(cairo_surface_status(svg.get()), path);
  io::write_file_atomically(path, bytes);
}

}  // namespace voxlist::drawing
