#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace voxlist::services {

/// Compresses the same bytes again and again as one zlib stream that any reader inflates, and costs
/// what has changed in them: they are cut into bands that do not refer to each other.
class BandedZlib {
 public:
  /// The stream. Throws std::runtime_error where zlib cannot.
  std::vector<std::uint8_t> compress(std::span<const std::uint8_t> bytes);

 private:
  struct Band {
    std::vector<std::uint8_t> bytes, deflated;
    unsigned long adler = 0;
  };
  static void deflate(Band& band);

  std::vector<Band> bands_;
};

}  // namespace voxlist::services
