#include "tests/scanner/velodyne/velodyne_encoder.h"

namespace voxlist::scanner::test {
namespace {

void put(std::vector<std::uint8_t>& bytes, std::uint32_t value, int n) {
  for (int i = 0; i < n; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

}  // namespace

double VelodyneEncoder::packet_us() const {
  const double single_us = model == 0x21 ? 12 * 46.08 : 24 * 55.296;
  return mode == 0x39 ? single_us / 2.0 : single_us;
}

std::vector<std::uint8_t> VelodyneEncoder::packet(const Returns& returns) {
  std::vector<std::uint8_t> bytes;
  for (int block = 0; block < 12; ++block) {
    const int turns = mode == 0x39 ? block / 2 : block;
    put(bytes, 0xEEFF, 2);
    put(bytes, static_cast<std::uint32_t>((azimuth_cdeg + turns * turn_cdeg) % 36'000), 2);
    for (int i = 0; i < 32; ++i) {
      const auto [range, intensity] = returns(block, i);
      put(bytes, static_cast<std::uint32_t>(range), 2);
      put(bytes, static_cast<std::uint32_t>(intensity), 1);
    }
  }
  put(bytes, stamp_us, 4);
  bytes.push_back(mode);
  bytes.push_back(model);
  azimuth_cdeg = (azimuth_cdeg + (mode == 0x39 ? 6 : 12) * turn_cdeg) % 36'000;
  passed_us_ += packet_us();
  const auto whole_us = static_cast<std::uint32_t>(passed_us_);
  passed_us_ -= whole_us;
  stamp_us = (stamp_us + whole_us) % 3'600'000'000U;
  return bytes;
}

}  // namespace voxlist::scanner::test
