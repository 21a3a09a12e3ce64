#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace voxlist::test {

/// A scan file as other people's programs write it, in one of the formats.
struct ScanSample {
  std::string extension;
  std::string encoding;
  std::string bytes;
};

/// The points that are in every sample.
std::vector<Eigen::Vector3f> sample_points();

/// The points in every format and encoding that can be read, with other elements, properties, lists
/// and padding around them.
std::vector<ScanSample> scan_samples();

/// A compressed PCD file of x, y and z (float), with this LZF data that unpacks to `size` bytes.
std::string compressed_pcd(std::size_t points, const std::string& packed, std::uint32_t size);

}  // namespace voxlist::test
