#include "tests/io/packets/capture.h"

#include <fstream>

namespace voxlist::io::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Of the file, lowest byte first; of the network, highest byte first.
void put_low(Bytes& bytes, std::uint32_t value, int n) {
  for (int i = 0; i < n; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}
void put_high(Bytes& bytes, std::size_t value, int n) {
  for (int i = n - 1; i >= 0; --i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

}  // namespace

Capture::Capture(std::uint32_t network) : network_(network) {
  put_low(bytes_, 0xA1B2C3D4, 4);
  put_low(bytes_, 2, 2);
  put_low(bytes_, 4, 2);
  put_low(bytes_, 0, 4);
  put_low(bytes_, 0, 4);
  put_low(bytes_, 65'535, 4);
  put_low(bytes_, network, 4);
}

void Capture::udp(std::int64_t utime_us, std::span<const std::uint8_t> payload, int port,
                  std::uint8_t from) {
  Bytes packet;
  if (network_ == 1) packet.assign(12, 0xAA);
  if (network_ == 113) packet.assign(14, 0xAA);
  if (network_ != 101) put_high(packet, 0x0800, 2);
  put_high(packet, 0x4500, 2);
  put_high(packet, 28 + payload.size(), 2);
  put_high(packet, 0x00004000, 4);  // number, "do not fragment"
  put_high(packet, 0xFF11, 2);      // life, UDP
  put_high(packet, 0, 2);
  for (const std::uint8_t part : {std::uint8_t{192}, std::uint8_t{168}, std::uint8_t{1}, from})
    packet.push_back(part);
  put_high(packet, 0xFFFFFFFF, 4);
  put_high(packet, 2368, 2);
  put_high(packet, static_cast<std::size_t>(port), 2);
  put_high(packet, 8 + payload.size(), 2);
  put_high(packet, 0, 2);
  packet.insert(packet.end(), payload.begin(), payload.end());
  frame(utime_us, packet);
}

void Capture::frame(std::int64_t utime_us, std::span<const std::uint8_t> bytes) {
  put_low(bytes_, static_cast<std::uint32_t>(utime_us / 1'000'000), 4);
  put_low(bytes_, static_cast<std::uint32_t>(utime_us % 1'000'000), 4);
  put_low(bytes_, static_cast<std::uint32_t>(bytes.size()), 4);
  put_low(bytes_, static_cast<std::uint32_t>(bytes.size()), 4);
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

void Capture::write(const std::filesystem::path& path) const {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes_.data()),
             static_cast<std::streamsize>(bytes_.size()));
}

}  // namespace voxlist::io::test
