#include "tests/drawing/pixels.h"

#include <png.h>

#include <algorithm>
#include <stdexcept>

#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"

namespace voxlist::test {

io::Rgb Pixels::at(int x, int y) const {
  return rgb.at(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(x));
}

std::size_t Pixels::count(io::Rgb colour) const {
  return static_cast<std::size_t>(std::ranges::count(rgb, colour));
}

Pixels pixels_of(const drawing::Picture& picture) {
  const TemporaryFolder folder;
  picture.write_png(folder / "a.png");
  const std::string bytes = io::read_file(folder / "a.png");
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()))
    throw std::runtime_error(image.message);
  image.format = PNG_FORMAT_RGB;
  Pixels pixels{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  pixels.rgb.resize(std::size_t{image.width} * image.height);
  if (!png_image_finish_read(&image, nullptr, pixels.rgb.data(), 0, nullptr))
    throw std::runtime_error(image.message);
  return pixels;
}

bool is_xml(const std::string& text) {
  std::vector<std::string> open;
  std::size_t at = text.find('<'), elements = 0;
  for (; at != std::string::npos; at = text.find('<', at + 1)) {
    const std::size_t end = text.find('>', at);
    if (end == std::string::npos) return false;
    const std::string tag = text.substr(at + 1, end - at - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" \n/", 1));
    if (tag.starts_with('?')) continue;
    if (tag.starts_with('/')) {
      if (open.empty() || "/" + open.back() != tag) return false;
      open.pop_back();
      continue;
    }
    if (open.empty() && elements > 0) return false;
    ++elements;
    if (!tag.ends_with('/')) open.push_back(name);
  }
  return elements > 0 && open.empty();
}

}  // namespace voxlist::test
