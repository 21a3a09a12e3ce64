#include <png.h>

#include <string>

#include "voxlist/drawing/picture.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"

namespace voxlist::drawing {

void write_png(const std::filesystem::path& path, const Picture& picture) {
  static_assert(sizeof(io::Rgb) == 3, "libpng reads the pixels as they lie in memory");
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width());
  image.height = static_cast<png_uint_32>(picture.height());
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.pixels().data(), 0,
                                 nullptr)) {
    throw io::FileError(path, std::string("cannot be encoded as PNG: ") + image.message);
  }
  bytes.resize(size);
  io::write_file_atomically(path, bytes);
}

}  // namespace voxlist::drawing
