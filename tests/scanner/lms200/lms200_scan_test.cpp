#include "voxlist/scanner/lms200/lms200_scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/scanner/lms200/lms200_vectors.h"

namespace voxlist::scanner {
namespace {

using Kind = Lms200Value::Kind;
using testing::ElementsAre;
using testing::SizeIs;
using testing::StrEq;

constexpr double kDeg = std::numbers::pi / 180.0;

Lms200ScanFormat format_of(int measuring_mode, bool millimetres) {
  Lms200ScanFormat format;
  format.measuring_mode = measuring_mode;
  format.millimetres = millimetres;
  return format;
}

// One value word in a scan that is otherwise empty.
Lms200Value decoded(unsigned word, const Lms200ScanFormat& format) {
  Lms200Telegram telegram = test::ramp(181, format.millimetres ? 0x40 : 0x00);
  telegram.data[2] = static_cast<std::uint8_t>(word & 0xFF);
  telegram.data[3] = static_cast<std::uint8_t>(word >> 8);
  const auto result = decode_scan(telegram, format);
  EXPECT_TRUE(result.scan);
  return result.scan ? result.scan->values[0] : Lms200Value{};
}

Lms200Scan random_scan(std::mt19937& random, const Lms200ScanFormat& format, int partial) {
  Lms200Scan scan;
  scan.partial = partial;
  scan.values.resize(format.values(partial));
  for (Lms200Value& value : scan.values) {
    value.kind = static_cast<Kind>(random() % 4);
    if (value.kind == Kind::kRange)
      value.range_m = static_cast<double>(random() % 8183) * format.unit_m();
  }
  scan.scan_index = format.index_bytes ? 200 : 0;
  scan.telegram_index = format.index_bytes ? 201 : 0;
  scan.status.polluted = random() % 2 == 0;
  return scan;
}

TEST(Lms200Scan, KindsOfValuesAreKeptApart) {
  const auto bytes = test::from_hex(test::kLms200Replies.back().bytes);
  Lms200ScanFormat format = format_of(0, false);
  format.angle_deg = 100;
  format.resolution_cdeg = 2500;  // five values
  const auto result =
      decode_scan({bytes[1], bytes[4], {bytes.begin() + 5, bytes.end() - 2}}, format);
  ASSERT_TRUE(result.scan) << result.refused;
  EXPECT_THAT(result.scan->values,
              ElementsAre(Lms200Value{Kind::kRange, 1.0, 0}, Lms200Value{Kind::kRange, 2.0, 0},
                          Lms200Value{Kind::kInvalid, 0.0, 0}, Lms200Value{Kind::kDazzled, 0.0, 0},
                          Lms200Value{Kind::kOverMaximum, 0.0, 0}));
}

TEST(Lms200Scan, RangesAreInTheConfiguredUnit) {
  for (const test::Lms200RampVector& vector : test::kLms200Ramps) {
    Lms200ScanFormat format = format_of(0, vector.unit_bits != 0);
    if (vector.values == 361) format.resolution_cdeg = 50;
    const auto result = decode_scan(test::ramp(vector.values, vector.unit_bits), format);
    ASSERT_TRUE(result.scan) << result.refused;
    EXPECT_DOUBLE_EQ(result.scan->values[180].range_m, format.millimetres ? 1.18 : 11.8);
    EXPECT_EQ(encode_scan(*result.scan, format), test::ramp(vector.values, vector.unit_bits));
  }
}

TEST(Lms200Scan, TheNumbersOfNoRangeAreThoseOfTheMeasuringMode) {
  for (const int mode : {0, 1, 2, 3, 4, 5, 6, 15}) {
    const auto format = format_of(mode, true);
    const unsigned mask = mode <= 2 ? 0x1FFF : mode <= 4 ? 0x3FFF : 0x7FFF;
    EXPECT_EQ(decoded(mask - 9, format).kind, Kind::kRange) << mode;
    EXPECT_EQ(decoded(mask - 8, format).kind, Kind::kOverMaximum) << mode;
    EXPECT_EQ(decoded(mask - 1, format).kind, Kind::kDazzled) << mode;
    for (const unsigned below : {0, 2, 3, 4, 5, 6, 7})
      EXPECT_EQ(decoded(mask - below, format).kind, Kind::kInvalid) << mode << ' ' << below;
    EXPECT_DOUBLE_EQ(format.range_limit_m(), (mask - 8) * 1e-3) << mode;
  }
}

TEST(Lms200Scan, UpperBitsMeanDazzleInModeZeroOnly) {
  EXPECT_EQ(decoded(0x83E8, format_of(0, true)).kind, Kind::kDazzled);
  EXPECT_EQ(decoded(0x63E8, format_of(0, true)), (Lms200Value{Kind::kRange, 1.0, 3}));
  for (const int mode : {1, 2})
    EXPECT_EQ(decoded(0x83E8, format_of(mode, true)), (Lms200Value{Kind::kRange, 1.0, 4})) << mode;
  EXPECT_EQ(decoded(0xA3E8, format_of(4, true)), (Lms200Value{Kind::kRange, 9.192, 2}));
}

TEST(Lms200Scan, ComesBackFromItsTelegramInEveryFormat) {
  std::mt19937 random(2);
  for (const int mode : {0, 1, 2, 4, 6})
    for (const bool millimetres : {false, true})
      for (const bool index_bytes : {false, true})
        for (const int resolution : {25, 50, 100}) {
          Lms200ScanFormat format = format_of(mode, millimetres);
          format.angle_deg = 100;
          format.resolution_cdeg = resolution;
          format.index_bytes = index_bytes;
          const Lms200Scan scan = random_scan(random, format, 0);
          const auto result = decode_scan(encode_scan(scan, format), format);
          ASSERT_TRUE(result.scan) << result.refused;
          EXPECT_EQ(*result.scan, scan);
        }
}

TEST(Lms200Scan, PartialScansBeginAQuarterOfADegreeLaterEach) {
  std::mt19937 random(3);
  Lms200ScanFormat format = format_of(0, true);
  format.partial_scans = true;
  for (const int resolution : {25, 50, 100})
    for (int partial = 0; partial < 4; ++partial) {
      format.resolution_cdeg = resolution;
      const Lms200Scan scan = random_scan(random, format, partial);
      const auto result = decode_scan(encode_scan(scan, format), format);
      if (partial * 25 % resolution != 0) {
        EXPECT_THAT(result.refused, StrEq("wrong_partial")) << resolution << ' ' << partial;
        continue;
      }
      ASSERT_TRUE(result.scan) << result.refused;
      EXPECT_EQ(*result.scan, scan);
      const LaserLine line = to_laser_line(scan, format, 77);
      EXPECT_THAT(line.ranges_m, SizeIs(partial == 0 ? 181 : 180));
      EXPECT_NEAR(line.first_angle_rad, partial * 0.25 * kDeg, 1e-12);
      EXPECT_NEAR(line.step_rad, kDeg, 1e-12);
      EXPECT_EQ(line.utime_us, 77);
    }
}

TEST(Lms200Scan, WhatIsNotAsConfiguredIsRefused) {
  const Lms200ScanFormat format = format_of(0, true);
  const auto refused = [&](const Lms200Telegram& telegram, const Lms200ScanFormat& with) {
    const auto result = decode_scan(telegram, with);
    return std::string(result.refused == nullptr ? "" : result.refused);
  };
  EXPECT_EQ(refused(test::ramp(181, 0x40), format), "");
  EXPECT_EQ(refused(test::ramp(181, 0x00), format), "wrong_unit");
  EXPECT_EQ(refused(test::ramp(181, 0x80), format), "wrong_unit");
  EXPECT_EQ(refused(test::ramp(180, 0x40), format), "wrong_count");
  EXPECT_EQ(refused(test::ramp(361, 0x40), format), "wrong_count");
  EXPECT_EQ(refused(test::ramp(181, 0x44), format), "wrong_count");    // reserved bit
  EXPECT_EQ(refused(test::ramp(181, 0x60), format), "wrong_partial");  // a partial scan
  EXPECT_EQ(refused(test::ramp(181, 0x50), format), "wrong_partial");  // its number
  Lms200ScanFormat other = format;
  other.index_bytes = true;
  EXPECT_EQ(refused(test::ramp(181, 0x40), other), "wrong_count");
  other = format;
  other.partial_scans = true;
  EXPECT_EQ(refused(test::ramp(181, 0x40), other), "wrong_partial");
  Lms200Telegram telegram = test::ramp(181, 0x40);
  telegram.data.back() = 0x12;
  EXPECT_EQ(refused(telegram, format), "");
  for (const unsigned status : {0x13u, 0x14u, 0x17u}) {
    telegram.data.back() = static_cast<std::uint8_t>(status);
    EXPECT_EQ(refused(telegram, format), "device_error");
  }
  EXPECT_EQ(refused({0x80, 0xB0, {0x10}}, format), "not_a_scan");
  EXPECT_EQ(refused({0x80, 0xA0, {0x00, 0x10}}, format), "not_a_scan");
}

TEST(Lms200Scan, StatusTellsOfPollution) {
  EXPECT_EQ(decode_lms200_status(0x10), Lms200Status{});
  EXPECT_EQ(decode_lms200_status(0x90), (Lms200Status{0, false, false, true}));
  EXPECT_EQ(decode_lms200_status(0x52), (Lms200Status{2, false, true, false}));
  EXPECT_EQ(decode_lms200_status(0x33), (Lms200Status{3, true, false, false}));
  for (const unsigned byte : {0x10u, 0x11u, 0x34u, 0x90u, 0xF2u})
    EXPECT_EQ(encode(decode_lms200_status(static_cast<std::uint8_t>(byte))), byte);
}

TEST(Lms200Scan, LineKeepsOverMaximumDazzleAndInvalidApart) {
  Lms200Scan scan;
  scan.values.resize(101);
  scan.values[0] = {Kind::kRange, 1.234, 0};
  scan.values[1].kind = Kind::kOverMaximum;
  scan.values[2].kind = Kind::kDazzled;
  Lms200ScanFormat format = format_of(0, true);
  format.angle_deg = 100;
  const LaserLine line = to_laser_line(scan, format, 5);
  EXPECT_FLOAT_EQ(line.ranges_m[0], 1.234f);
  EXPECT_EQ(line.ranges_m[1], std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(line.ranges_m[2]) && std::isnan(line.ranges_m[3]));
  EXPECT_EQ(line.dazzled[2], 1);
  EXPECT_EQ(line.dazzled[3], 0);
  EXPECT_NEAR(line.first_angle_rad, 40 * kDeg, 1e-12);
  scan.values[2].kind = Kind::kInvalid;
  EXPECT_TRUE(to_laser_line(scan, format, 5).dazzled.empty());
}

TEST(Lms200Scan, EveryMillimetreSurvivesTheLine) {
  const Lms200ScanFormat format = format_of(0, true);
  for (int base = 0; base < 8183; base += 181) {
    LaserLine line;
    for (int i = 0; i < 181; ++i)
      line.ranges_m.push_back(static_cast<float>(std::min(base + i, 8182) / 1000.0));
    Lms200Scan scan;
    scan.values = to_values(line);
    const auto result = decode_scan(encode_scan(scan, format), format);
    ASSERT_TRUE(result.scan);
    EXPECT_EQ(to_laser_line(*result.scan, format, 0).ranges_m, line.ranges_m);
  }
}

TEST(Lms200Scan, RangesPastTheLimitAreOverMaximum) {
  const Lms200ScanFormat format = format_of(0, true);
  LaserLine line;
  line.ranges_m.assign(181, 8.1826f);
  line.ranges_m[1] = 9.0f;
  line.ranges_m[2] = 1e30f;
  line.ranges_m[3] = -1.0f;
  Lms200Scan scan;
  scan.values = to_values(line);
  const auto values = decode_scan(encode_scan(scan, format), format).scan->values;
  for (const std::size_t i : {0u, 1u, 2u}) EXPECT_EQ(values[i].kind, Kind::kOverMaximum) << i;
  EXPECT_EQ(values[3], (Lms200Value{Kind::kRange, 0.0, 0}));
}

}  // namespace
}  // namespace voxlist::scanner
