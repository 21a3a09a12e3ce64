#include "voxlist/io/packets/pcap_file.h"

#include <fmt/core.h>
#include <pcap/pcap.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>

#include "voxlist/io/files/file.h"

namespace voxlist::io {
namespace {

using Bytes = std::span<const std::uint8_t>;

std::size_t u16_at(Bytes bytes, std::size_t at) {
  return static_cast<std::size_t>(bytes[at] << 8 | bytes[at + 1]);
}

// What follows the head of an Ethernet frame, behind the tags of virtual networks.
Bytes behind_ethernet(Bytes frame) {
  constexpr std::size_t kTypeAt = 12, kTagBytes = 4, kTag = 0x8100, kIp = 0x0800;
  std::size_t at = kTypeAt;
  while (at + 2 <= frame.size() && u16_at(frame, at) == kTag) at += kTagBytes;
  if (at + 2 > frame.size() || u16_at(frame, at) != kIp) return {};
  return frame.subspan(at + 2);
}

// The IPv4 packet of a frame; empty when it holds none, or the network is not known.
Bytes ip_packet(Bytes frame, int network) {
  constexpr std::size_t kCookedHead = 16, kLoopbackHead = 4;
  if (network == DLT_EN10MB) return behind_ethernet(frame);
  const std::size_t head = network == DLT_LINUX_SLL ? kCookedHead
                           : network == DLT_NULL    ? kLoopbackHead
                                                    : 0;
  return frame.size() < head ? Bytes() : frame.subspan(head);
}

bool is_known(int network) {
  return network == DLT_EN10MB || network == DLT_LINUX_SLL || network == DLT_NULL ||
         network == DLT_RAW || network == DLT_IPV4;
}

// The packet's sender, port and payload, when it is a whole UDP packet.
std::optional<UdpPacket> udp_packet(Bytes ip) {
  constexpr std::size_t kIpHead = 20, kUdpHead = 8;
  constexpr std::uint8_t kUdp = 17;
  constexpr std::size_t kFragment = 0x3FFF;  // offset, and "more follow"
  if (ip.size() < kIpHead || ip[0] >> 4 != 4 || ip[9] != kUdp) return std::nullopt;
  const std::size_t head = 4U * (ip[0] & 0x0FU);
  if (head < kIpHead || ip.size() < head + kUdpHead) return std::nullopt;
  if ((u16_at(ip, 6) & kFragment) != 0) return std::nullopt;
  const Bytes udp = ip.subspan(head);
  const std::size_t length = u16_at(udp, 4);
  if (length < kUdpHead || length > udp.size()) return std::nullopt;
  return UdpPacket{0, fmt::format("{}.{}.{}.{}", ip[12], ip[13], ip[14], ip[15]),
                   static_cast<int>(u16_at(udp, 2)), udp.subspan(kUdpHead, length - kUdpHead)};
}

}  // namespace

PcapFile::PcapFile(const std::filesystem::path& path) : path_(path), file_(nullptr, pcap_close) {
  std::array<char, PCAP_ERRBUF_SIZE> why{};
  file_.reset(pcap_open_offline_with_tstamp_precision(path.c_str(), PCAP_TSTAMP_PRECISION_MICRO,
                                                      why.data()));
  if (!file_) throw FileError(path, fmt::format("is no recording of packets: {}", why.data()));
  network_ = pcap_datalink(file_.get());
  if (!is_known(network_))
    throw FileError(path, fmt::format("is of a network that is not known ({}): record from "
                                      "Ethernet",
                                      pcap_datalink_val_to_description_or_dlt(network_)));
  size_bytes_ = static_cast<double>(std::filesystem::file_size(path)) + 1.0;
}

std::optional<UdpPacket> PcapFile::next() {
  pcap_pkthdr* head = nullptr;
  const std::uint8_t* bytes = nullptr;
  int got = 0;
  while ((got = pcap_next_ex(file_.get(), &head, &bytes)) == 1) {
    if (auto packet = udp_packet(ip_packet({bytes, head->caplen}, network_))) {
      packet->utime_us = std::int64_t{head->ts.tv_sec} * 1'000'000 + head->ts.tv_usec;
      return packet;
    }
    ++others_;
  }
  if (got == PCAP_ERROR)
    complaint_ = fmt::format("{}: ends in the middle: {}; what comes before is used",
                             path_.string(), pcap_geterr(file_.get()));
  return std::nullopt;
}

double PcapFile::progress() const {
  return static_cast<double>(ftell(pcap_file(file_.get()))) / size_bytes_;
}

bool is_pcap(const std::filesystem::path& path) {
  constexpr std::array<std::uint32_t, 5> kMarks{0xA1B2C3D4, 0xD4C3B2A1, 0xA1B23C4D, 0x4D3CB2A1,
                                                0x0A0D0D0A};
  std::uint32_t mark = 0;
  std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(&mark), sizeof mark);
  return std::ranges::find(kMarks, mark) != kMarks.end();
}

}  // namespace voxlist::io
