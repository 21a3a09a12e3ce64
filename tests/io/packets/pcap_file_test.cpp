#include "voxlist/io/packets/pcap_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/packets/capture.h"
#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"

namespace voxlist::io {
namespace {

using ::testing::HasSubstr;
using voxlist::test::TemporaryFolder;

constexpr std::int64_t kTime_us = 1'700'000'000'123'456;
const std::vector<std::uint8_t> kPayload{1, 2, 3, 4, 5};

std::vector<std::uint8_t> copy(const UdpPacket& packet) {
  return {packet.payload.begin(), packet.payload.end()};
}

TEST(PcapFile, ReadsUdpPacketsOfEachKnownNetwork) {
  const TemporaryFolder folder;
  for (const std::uint32_t network : {1U, 101U, 113U}) {
    test::Capture capture(network);
    capture.udp(kTime_us, kPayload, 8308, 7);
    capture.udp(kTime_us + 5, {});
    capture.write(folder / "a.pcap");
    ASSERT_TRUE(is_pcap(folder / "a.pcap"));
    PcapFile file(folder / "a.pcap");
    const auto packet = file.next();
    ASSERT_TRUE(packet) << network;
    EXPECT_EQ(packet->utime_us, kTime_us);
    EXPECT_EQ(packet->from, "192.168.1.7");
    EXPECT_EQ(packet->port, 8308);
    EXPECT_EQ(copy(*packet), kPayload);
    EXPECT_TRUE(file.next());
    EXPECT_FALSE(file.next());
    EXPECT_EQ(file.complaint(), "");
    EXPECT_EQ(file.others(), 0);
    EXPECT_NEAR(file.progress(), 1.0, 0.05);
  }
}

TEST(PcapFile, PassesOverWhatIsNoWholeUdpPacket) {
  const TemporaryFolder folder;
  test::Capture capture;
  for (std::size_t size = 0; size < 45; ++size)
    capture.frame(kTime_us, std::vector<std::uint8_t>(size, 0x45));
  test::Capture whole;
  whole.udp(kTime_us, kPayload);
  const std::size_t head = 24 + 16;
  std::vector<std::uint8_t> frame(whole.bytes().begin() + head, whole.bytes().end());
  for (std::size_t size = 0; size < frame.size(); ++size)
    capture.frame(kTime_us, std::span(frame).first(size));
  frame[14 + 6] = 0x20;  // a fragment: more follow
  capture.frame(kTime_us, frame);
  capture.udp(kTime_us, kPayload);
  capture.write(folder / "a.pcap");
  PcapFile file(folder / "a.pcap");
  const auto packet = file.next();
  ASSERT_TRUE(packet);
  EXPECT_EQ(copy(*packet), kPayload);
  EXPECT_FALSE(file.next());
  EXPECT_EQ(file.others(), 45 + static_cast<std::int64_t>(frame.size()) + 1);
}

TEST(PcapFile, GivesWhatComesBeforeACutAndSaysSo) {
  const TemporaryFolder folder;
  test::Capture capture;
  for (int i = 0; i < 3; ++i) capture.udp(kTime_us + i, kPayload);
  const std::string all(capture.bytes().begin(), capture.bytes().end());
  const std::size_t of_one = (all.size() - 24) / 3;
  for (std::size_t cut = 1; cut < of_one; ++cut) {
    const auto path = folder.write("cut.pcap", all.substr(0, all.size() - cut));
    PcapFile file(path);
    EXPECT_TRUE(file.next());
    EXPECT_TRUE(file.next());
    EXPECT_FALSE(file.next());
    EXPECT_THAT(file.complaint(), HasSubstr("ends in the middle")) << cut;
  }
}

TEST(PcapFile, RefusesWhatIsNone) {
  const TemporaryFolder folder;
  EXPECT_FALSE(is_pcap(folder / "none"));
  EXPECT_FALSE(is_pcap(folder.write("short", "ab")));
  EXPECT_THROW(PcapFile(folder / "none"), FileError);
  EXPECT_THROW(PcapFile(folder.write("text", "no recording of packets at all")), FileError);
  test::Capture(147).write(folder / "user.pcap");
  EXPECT_THROW(PcapFile(folder / "user.pcap"), FileError);
}

}  // namespace
}  // namespace voxlist::io
