#pragma once

#include <Eigen/Core>
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

/// LZF of the simplest kind: literals only.
std::string pack_lzf_literally(const std::string& bytes);

}  // namespace voxlist::test
