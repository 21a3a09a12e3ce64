#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

struct pcap;  // libpcap's

namespace voxlist::io {

/// A UDP packet (IPv4) as it was recorded.
struct UdpPacket {
  std::int64_t utime_us = 0;
  std::string from;                       ///< the sender's address: "192.168.1.201"
  int port = 0;                           ///< that it was sent to
  std::span<const std::uint8_t> payload;  ///< until the next one is read
};

/// A recording of tcpdump, Wireshark or dumpcap.
class PcapFile {
 public:
  /// Throws FileError when it cannot be read, is no such recording, or of a network whose packets
  /// are not known.
  explicit PcapFile(const std::filesystem::path& path);

  /// The next UDP packet; nothing at the end of the file, or where it is broken.
  std::optional<UdpPacket> next();

  /// Why the file ended before its end, for a person; empty when it did not.
  const std::string& complaint() const { return complaint_; }

  /// What was no whole UDP packet: of another kind, a fragment, or recorded in part.
  std::int64_t others() const { return others_; }

  /// How much of the file has been read, 0 to 1.
  double progress() const;

 private:
  std::filesystem::path path_;
  std::unique_ptr<pcap, void (*)(pcap*)> file_;
  int network_ = 0;
  std::string complaint_;
  std::int64_t others_ = 0;
  double size_bytes_ = 1.0;
};

/// Whether a file begins as such a recording does.
bool is_pcap(const std::filesystem::path& path);

}  // namespace voxlist::io
