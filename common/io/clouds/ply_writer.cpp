#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <string>

#include "voxlist/io/clouds/cloud_file.h"
#include "voxlist/io/files/atomic_file.h"

namespace voxlist::io {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY is written as the memory holds it");

constexpr std::string_view kOriginProperties =
    "property float origin_x\nproperty float origin_y\nproperty float origin_z\n";
constexpr std::string_view kColourProperties =
    "property uchar red\nproperty uchar green\nproperty uchar blue\n";

std::string header(std::size_t points, std::string_view more_properties,
                   const std::string& comment = {}) {
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\n{}element vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n{}end_header\n",
      comment.empty() ? comment : "comment " + comment + '\n', points, more_properties);
}

template <typename T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

}  // namespace

void write_ply(const std::filesystem::path& path, const Cloud& cloud) {
  const bool has_origins = !cloud.origins.empty();
  std::string bytes = header(cloud.points.size(), has_origins ? kOriginProperties : "");
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    append(bytes, cloud.points[i]);
    if (has_origins) {
      append(bytes, cloud.origins[i]);
    }
  }
  write_file_atomically(path, bytes);
}

void write_ply(const std::filesystem::path& path, const std::vector<Eigen::Vector3f>& points,
               const std::vector<io::Rgb>& colours, const std::string& comment) {
  if (points.size() != colours.size()) {
    throw std::invalid_argument("write_ply: as many colours as points are needed");
  }
  std::string bytes = header(points.size(), kColourProperties, comment);
  for (std::size_t i = 0; i < points.size(); ++i) {
    append(bytes, points[i]);
    append(bytes, colours[i]);
  }
  write_file_atomically(path, bytes);
}

std::vector<io::Rgb> colours_by_height(const std::vector<Eigen::Vector3f>& points) {
  std::vector<float> heights;
  for (const auto& p : points) {
    heights.push_back(p.z());
  }
  std::sort(heights.begin(), heights.end());
  const std::size_t margin = heights.size() / 100;
  std::vector<io::Rgb> colours;
  for (const auto& p : points) {
    const float low = heights[margin], high = heights[heights.size() - 1 - margin];
    colours.push_back(io::viridis(high > low ? (p.z() - low) / (high - low) : 0.0F));
  }
  return colours;
}

}  // namespace voxlist::io
