#include "tests/io/scans/scan_files.h"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <sstream>

namespace voxlist::test {
namespace {

template <typename T>
std::string raw(T value, bool big_endian = false) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof(T));
  if (big_endian) {
    std::reverse(bytes.begin(), bytes.end());
  }
  return bytes;
}

std::string number(float value) {
  std::ostringstream text;
  text.precision(9);
  text << value;
  return text.str();
}

// camera: a list and a number before the vertices; vertex: intensity, z (double), list, x, y; faces
// after.
std::string ply_header(const std::string& format, std::size_t points) {
  return "ply\r\nformat " + format + " 1.0\r\ncomment made elsewhere\r\nobj_info num_cols 4\r\n" +
         "element camera 1\r\nproperty list uchar short view\r\nproperty float32 focal\r\n" +
         "element vertex " + std::to_string(points) + "\r\nproperty uchar intensity\r\n" +
         "property double z\r\nproperty list uint8 int32 neighbours\r\nproperty float32 x\r\n" +
         "property float y\r\nelement face 1\r\nproperty list uchar int "
         "vertex_indices\r\nend_header\r\n";
}

ScanSample ply_text() {
  std::string bytes = ply_header("ascii", sample_points().size()) + "3 -1 2 3 0.5\r\n";
  for (const auto& p : sample_points()) {
    bytes += "200 " + number(p.z()) + " 2 7 8 " + number(p.x()) + " " + number(p.y()) + "\r\n";
  }
  return {".ply", "ascii", bytes + "3 0 1 2\r\n"};
}

ScanSample ply_binary(const std::string& format) {
  const bool big = format == "binary_big_endian";
  std::string bytes = ply_header(format, sample_points().size());
  bytes += raw(std::uint8_t{2}) + raw(std::int16_t{-1}, big) + raw(std::int16_t{300}, big);
  bytes += raw(0.5F, big);
  for (const auto& p : sample_points()) {
    bytes += raw(std::uint8_t{200}) + raw(static_cast<double>(p.z()), big) + raw(std::uint8_t{1});
    bytes += raw(std::int32_t{7}, big) + raw(p.x(), big) + raw(p.y(), big);
  }
  return {".ply", format, bytes + raw(std::uint8_t{1}) + raw(std::int32_t{0}, big)};
}

std::string pcd_header(const std::string& encoding, std::size_t points) {
  const std::string n = std::to_string(points);
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y _ z intensity "
         "normal\n"
         "SIZE 4 4 1 8 2 4\nTYPE F F U F U F\nCOUNT 1 1 4 1 1 3\nWIDTH " +
         n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA " + encoding + "\n";
}

ScanSample pcd_text() {
  std::string bytes = pcd_header("ascii", sample_points().size());
  for (const auto& p : sample_points()) {
    bytes += number(p.x()) + " " + number(p.y()) + " 0 0 0 0 " + number(p.z()) + " 12 nan 0 1\n";
  }
  return {".pcd", "ascii", bytes};
}

ScanSample pcd_binary() {
  std::string bytes = pcd_header("binary", sample_points().size());
  for (const auto& p : sample_points()) {
    bytes += raw(p.x()) + raw(p.y()) + "____" + raw(static_cast<double>(p.z()));
    bytes += raw(std::uint16_t{12}) + raw(0.0F) + raw(0.0F) + raw(1.0F);
  }
  return {".pcd", "binary", bytes};
}

// LZF of the simplest kind: literals only.
std::string pack_lzf_literally(const std::string& bytes) {
  std::string packed;
  for (std::size_t at = 0; at < bytes.size(); at += 32) {
    const std::string literals = bytes.substr(at, 32);
    packed += static_cast<char>(literals.size() - 1) + literals;
  }
  return packed;
}

ScanSample pcd_compressed() {
  const auto points = sample_points();
  std::string x, y, z;
  for (const auto& p : points) {
    x += raw(p.x());
    y += raw(p.y());
    z += raw(static_cast<double>(p.z()));
  }
  // As PCL does it: the padding is in the header, not in the data.
  const std::string columns = x + y + z + std::string(points.size() * 14, '\1');
  const std::string packed = pack_lzf_literally(columns);
  return {".pcd", "binary_compressed",
          pcd_header("binary_compressed", points.size()) +
              raw(static_cast<std::uint32_t>(packed.size())) +
              raw(static_cast<std::uint32_t>(columns.size())) + packed};
}

}  // namespace

std::vector<Eigen::Vector3f> sample_points() {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 20; ++i) {
    const auto v = static_cast<float>(i);
    points.emplace_back(0.25F * v, -1.5F + 0.1F * v, 2.0F - v / 3.0F);
  }
  return points;
}

std::vector<ScanSample> scan_samples() {
  return {ply_text(),
          ply_binary("binary_little_endian"),
          ply_binary("binary_big_endian"),
          pcd_text(),
          pcd_binary(),
          pcd_compressed()};
}

std::string compressed_pcd(std::size_t points, const std::string& packed, std::uint32_t size) {
  return "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH " + std::to_string(points) +
         "\nHEIGHT 1\nDATA binary_compressed\n" + raw(static_cast<std::uint32_t>(packed.size())) +
         raw(size) + packed;
}

}  // namespace voxlist::test
