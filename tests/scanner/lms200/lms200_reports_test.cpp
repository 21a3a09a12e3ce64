#include "voxlist/scanner/lms200/lms200_reports.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scanner/lms200/lms200_vectors.h"

namespace voxlist::scanner {
namespace {

using testing::ElementsAre;

TEST(Lms200Reports, StatusIsReadAtThePlacesOfTheManual) {
  Lms200Telegram telegram{0x80, 0xB1, std::vector<std::uint8_t>(153)};
  const std::string firmware = "V02.10 ";
  std::copy(firmware.begin(), firmware.end(), telegram.data.begin());
  // Offsets count from the command byte.
  const auto put = [&](std::size_t offset, int byte) {
    telegram.data[offset - 1] = static_cast<std::uint8_t>(byte);
  };
  put(8, 0x25), put(102, 0x01), put(107, 100), put(109, 25), put(116, 0x01), put(117, 0x80);
  put(119, 1), put(120, 3), put(122, 1), put(123, 1);
  telegram.data.back() = 0x90;
  const auto report = decode_status_report(telegram);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->firmware, "V02.10");
  EXPECT_EQ(report->mode, 0x25);
  EXPECT_FALSE(report->defect);
  EXPECT_EQ(report->measuring_mode, 1);
  EXPECT_EQ(report->angle_deg, 100);
  EXPECT_EQ(report->resolution_cdeg, 25);
  EXPECT_EQ(report->baud, 500000);
  EXPECT_TRUE(report->baud_permanent);
  EXPECT_EQ(report->address, 3);
  EXPECT_EQ(report->units, 1);
  EXPECT_TRUE(report->laser_on);
  EXPECT_TRUE(report->status.polluted);
  EXPECT_EQ(encode_status_report(*report), telegram);
}

TEST(Lms200Reports, ShortStatusLeavesOutReservedBytes) {
  Lms200StatusReport report;
  report.firmware = "V01.00";
  report.mode = 0x24;
  report.angle_deg = 180;
  report.baud = 38400;
  Lms200Telegram telegram = encode_status_report(report);
  telegram.data.erase(telegram.data.begin() + 20, telegram.data.begin() + 26);
  const auto read = decode_status_report(telegram);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->mode, 0x24);
  EXPECT_EQ(read->angle_deg, 180);
  EXPECT_EQ(read->baud, 38400);
  telegram.data.pop_back();
  EXPECT_FALSE(decode_status_report(telegram));
}

TEST(Lms200Reports, ConfigurationIsAllButTheStatus) {
  for (const std::size_t bytes : {32u, 34u}) {
    Lms200Telegram telegram{0x80, 0xF4, std::vector<std::uint8_t>(bytes, 7)};
    telegram.data.push_back(0x10);
    const auto configuration = decode_configuration(telegram);
    ASSERT_TRUE(configuration);
    EXPECT_EQ(configuration->bytes, std::vector<std::uint8_t>(bytes, 7));
    telegram.command = 0xF7;
    EXPECT_FALSE(decode_configuration(telegram));
    telegram.data.insert(telegram.data.begin(), 1);
    const auto written = decode_written(telegram);
    ASSERT_TRUE(written);
    EXPECT_TRUE(written->accepted);
    EXPECT_EQ(written->configuration, *configuration);
    telegram.data[0] = 0;
    EXPECT_FALSE(decode_written(telegram)->accepted);
  }
}

TEST(Lms200Reports, ShortAnswersSayYesOrNo) {
  EXPECT_EQ(decode_mode_changed({0x80, 0xA0, {0, 0x10}}), true);
  EXPECT_EQ(decode_mode_changed({0x80, 0xA0, {1, 0x10}}), false);
  EXPECT_EQ(decode_mode_changed({0x80, 0x92, {0x10}}), std::nullopt);
  EXPECT_EQ(decode_variant_accepted({0x80, 0xBB, {1, 0xB4, 0, 0x64, 0, 0x10}}), true);
  EXPECT_EQ(decode_variant_accepted({0x80, 0xBB, {0, 0xB4, 0, 0x64, 0, 0x10}}), false);
}

TEST(Lms200Reports, TypeIsTextWithoutItsPadding) {
  const auto bytes = test::from_hex(
      "02 81 17 00 90 4C 4D 53 32 30 30 3B 33 30 31 30 36 33 3B 56 30 32 2E 30 36 20 13 64 5A");
  Lms200Telegram telegram{bytes[1], bytes[4], {bytes.begin() + 5, bytes.end() - 2}};
  EXPECT_EQ(decode_type(telegram), "LMS200;301063;V02.06");
  telegram.command = 0xBA;
  EXPECT_EQ(decode_type(telegram), "LMS200;301063;V02.06");
  telegram.command = 0xB1;
  EXPECT_EQ(decode_type(telegram), std::nullopt);
}

TEST(Lms200Reports, ErrorMemoryIsPairs) {
  EXPECT_THAT(*decode_errors({0x80, 0xB2, {3, 22, 0x82, 7, 0x10}}),
              ElementsAre(Lms200Error{3, 22}, Lms200Error{0x82, 7}));
  EXPECT_TRUE(decode_errors({0x80, 0xB2, {0x10}})->empty());
  EXPECT_FALSE(decode_errors({0x80, 0xB0, {0x10}}));
}

}  // namespace
}  // namespace voxlist::scanner
