#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace voxlist::scanner::test {

/// Writes the data packets of a Velodyne laser, byte by byte, by its published format.
struct VelodyneEncoder {
  std::uint8_t model = 0x22;   ///< VLP-16; HDL-32E: 0x21
  std::uint8_t mode = 0x37;    ///< strongest return; both: 0x39
  int azimuth_cdeg = 0;        ///< of the next packet's first block
  int turn_cdeg = 40;          ///< from block to block (with both returns: from pair to pair)
  std::uint32_t stamp_us = 0;  ///< of the next packet

  /// Range in units of 2 mm and intensity of the return with this number in a block.
  using Returns = std::function<std::pair<int, int>(int block, int i)>;

  /// The next packet; the laser turns on, its clock too.
  std::vector<std::uint8_t> packet(const Returns& returns);

  double packet_us() const;

 private:
  double passed_us_ = 0.0;  // of a microsecond that the stamp does not tell
};

}  // namespace voxlist::scanner::test
