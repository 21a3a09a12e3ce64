#include "services/voxlist/report/charts/svg.h"

#include <fmt/core.h>

#include <cmath>

namespace voxlist::desk {
namespace {

// A tenth of a pixel is as fine as anybody sees.
std::string pixel(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

std::string place(const Eigen::Vector2d& at) { return pixel(at.x()) + ' ' + pixel(at.y()); }

}  // namespace

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += static_cast<unsigned char>(c) < 0x20 && c != '\n' ? ' ' : c;
    }
  }
  return safe;
}

Svg::Svg(double width, double height, const std::string& title)
    : text_(fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" "
                        "width=\"{0}\" height=\"{1}\" role=\"img\"><title>{2}</title>\n",
                        pixel(width), pixel(height), escaped(title))) {}

void Svg::line(const std::vector<Eigen::Vector2d>& points, const std::string& css) {
  std::string path;
  bool joined = false;
  for (const Eigen::Vector2d& point : points) {
    if (!point.allFinite()) {
      joined = false;
      continue;
    }
    path.append(joined ? "L" : "M").append(place(point));
    joined = true;
  }
  if (!path.empty()) text_ += fmt::format("<path class=\"line {}\" d=\"{}\"/>\n", css, path);
}

void Svg::dots(const std::vector<Eigen::Vector2d>& centres, double diameter,
               const std::string& css) {
  std::string path;
  for (const Eigen::Vector2d& centre : centres)
    if (centre.allFinite()) path.append("M").append(place(centre)).append("h0");
  if (path.empty()) return;
  text_ += fmt::format("<path class=\"dots {}\" stroke-width=\"{}\" d=\"{}\"/>\n", css,
                       pixel(diameter), path);
}

void Svg::boxes(const std::vector<Eigen::Vector2d>& corners, const Eigen::Vector2d& size,
                const std::string& css) {
  std::string path;
  const std::string shape =
      fmt::format("h{}v{}h-{}z", pixel(size.x()), pixel(size.y()), pixel(size.x()));
  for (const Eigen::Vector2d& corner : corners)
    if (corner.allFinite()) path.append("M").append(place(corner)).append(shape);
  if (!path.empty()) text_ += fmt::format("<path class=\"fill {}\" d=\"{}\"/>\n", css, path);
}

void Svg::box(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const std::string& css) {
  const Eigen::Vector2d corner = a.cwiseMin(b), size = (a - b).cwiseAbs();
  if (!corner.allFinite() || !size.allFinite()) return;
  text_ += fmt::format("<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", css,
                       pixel(corner.x()), pixel(corner.y()), pixel(size.x()), pixel(size.y()));
}

void Svg::text(const Eigen::Vector2d& at, const std::string& words, const std::string& css,
               const std::string& anchor) {
  text_ += fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}</text>\n", css,
                       pixel(at.x()), pixel(at.y()), anchor, escaped(words));
}

}  // namespace voxlist::desk
