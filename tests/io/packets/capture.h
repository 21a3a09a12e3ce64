#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace voxlist::io::test {

/// A recording of a network as tcpdump writes it, byte by byte.
class Capture {
 public:
  /// `network`: 1 is Ethernet, 113 Linux cooked, 101 raw IP.
  explicit Capture(std::uint32_t network = 1);

  /// A UDP packet from 192.168.1.`from` to a port.
  void udp(std::int64_t utime_us, std::span<const std::uint8_t> payload, int port = 2368,
           std::uint8_t from = 201);

  /// Any frame.
  void frame(std::int64_t utime_us, std::span<const std::uint8_t> bytes);

  const std::vector<std::uint8_t>& bytes() const { return bytes_; }
  void write(const std::filesystem::path& path) const;

 private:
  std::uint32_t network_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace voxlist::io::test
