#include "voxlist/scanner/lms200/lms200_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "voxlist/geometry/angle.h"
#include "voxlist/scanner/lms200/lms200_commands.h"

namespace voxlist::scanner {
namespace {

using Kind = Lms200Value::Kind;

// Status byte.
constexpr unsigned kSeverityMask = 0x07, kOrdinaryUnit = 0x10, kRestarted = 0x20,
                   kImplausible = 0x40, kPolluted = 0x80;
constexpr int kWarning = 2;

// Count word. Bit 10 is reserved: with it the count is wrong.
constexpr unsigned kCountMask = 0x07FF, kPartialShift = 11, kPartialMask = 0x3,
                   kPartialBit = 0x2000, kUnitShift = 14, kCentimetres = 0, kMillimetres = 1;

// The greatest numbers are no ranges: counted down from the greatest of all.
constexpr unsigned kBelowInvalid = 0, kBelowDazzled = 1, kBelowOverMaximum = 8;
constexpr unsigned kDazzleBit = 0x8000;  // of measuring mode 0

constexpr std::size_t kCountBytes = 2, kIndexBytes = 2, kStatusBytes = 1;

unsigned range_bits(int measuring_mode) {
  if (measuring_mode <= 2) return 13;
  return measuring_mode <= 4 ? 14 : 15;
}

unsigned range_mask(const Lms200ScanFormat& format) {
  return (1u << range_bits(format.measuring_mode)) - 1u;
}

unsigned unit_bits(const Lms200ScanFormat& format) {
  return format.millimetres ? kMillimetres : kCentimetres;
}

unsigned word(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  return bytes[at] | static_cast<unsigned>(bytes[at + 1]) << 8;
}

void put_word(std::vector<std::uint8_t>& bytes, unsigned word) {
  bytes.push_back(static_cast<std::uint8_t>(word & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(word >> 8 & 0xFF));
}

bool known_partial(const Lms200ScanFormat& format, int partial) {
  if (!format.partial_scans) return partial == 0;
  return partial * 25 % format.resolution_cdeg == 0 && partial * 25 < 100;
}

Lms200Value decode_value(unsigned word, const Lms200ScanFormat& format) {
  const unsigned mask = range_mask(format);
  const unsigned below = mask - (word & mask);
  Lms200Value value;
  value.flags = static_cast<std::uint8_t>((word & ~mask) >> range_bits(format.measuring_mode));
  const bool dazzle_bit = format.measuring_mode == 0 && (word & kDazzleBit) != 0;
  if (dazzle_bit) value.flags &= kDazzleBit / 0x2000 - 1;
  if (dazzle_bit || below == kBelowDazzled) {
    value.kind = Kind::kDazzled;
  } else if (below == kBelowOverMaximum) {
    value.kind = Kind::kOverMaximum;
  } else if (below > kBelowOverMaximum) {
    value.kind = Kind::kRange;
    value.range_m = (word & mask) * format.unit_m();
  }
  return value;
}

unsigned encode_value(const Lms200Value& value, const Lms200ScanFormat& format) {
  const unsigned mask = range_mask(format);
  const unsigned flags = static_cast<unsigned>(value.flags) << range_bits(format.measuring_mode);
  const auto code = [&](unsigned below) { return flags | (mask - below); };
  switch (value.kind) {
    case Kind::kOverMaximum:
      return code(kBelowOverMaximum);
    case Kind::kDazzled:
      return code(kBelowDazzled);
    case Kind::kInvalid:
      return code(kBelowInvalid);
    case Kind::kRange:
      break;
  }
  const double units = std::round(std::max(value.range_m, 0.0) / format.unit_m());
  if (!(units < mask - kBelowOverMaximum)) return code(kBelowOverMaximum);
  return flags | static_cast<unsigned>(units);
}

const char* refusal(const Lms200Telegram& telegram, const Lms200ScanFormat& format) {
  const std::vector<std::uint8_t>& data = telegram.data;
  if (telegram.command != lms200::kScan || data.size() < kCountBytes + kStatusBytes)
    return "not_a_scan";
  const unsigned head = word(data, 0);
  if (head >> kUnitShift != unit_bits(format)) return "wrong_unit";
  const int partial = static_cast<int>(head >> kPartialShift & kPartialMask);
  const bool is_partial = (head & kPartialBit) != 0;
  if (is_partial != format.partial_scans || !known_partial(format, partial)) return "wrong_partial";
  const std::size_t values = format.values(partial);
  const std::size_t indices = format.index_bytes ? kIndexBytes : 0;
  if ((head & kCountMask) != values ||
      data.size() != kCountBytes + 2 * values + indices + kStatusBytes)
    return "wrong_count";
  if (decode_lms200_status(data.back()).severity > kWarning) return "device_error";
  return nullptr;
}

}  // namespace

Lms200Status decode_lms200_status(std::uint8_t byte) {
  return {static_cast<int>(byte & kSeverityMask), (byte & kRestarted) != 0,
          (byte & kImplausible) != 0, (byte & kPolluted) != 0};
}

std::uint8_t encode(const Lms200Status& status) {
  return static_cast<std::uint8_t>(
      kOrdinaryUnit | (static_cast<unsigned>(status.severity) & kSeverityMask) |
      (status.restarted ? kRestarted : 0u) | (status.implausible ? kImplausible : 0u) |
      (status.polluted ? kPolluted : 0u));
}

bool Lms200ScanFormat::known_mode() const {
  return (measuring_mode >= 0 && measuring_mode <= 6) || measuring_mode == 15;
}

double Lms200ScanFormat::range_limit_m() const {
  return (range_mask(*this) - kBelowOverMaximum) * unit_m();
}

std::size_t Lms200ScanFormat::values(int partial) const {
  if (partial_scans) return partial == 0 ? 181 : 180;
  return static_cast<std::size_t>(angle_deg * 100 / resolution_cdeg + 1);
}

double Lms200ScanFormat::first_angle_rad(int partial) const {
  const int covered_deg = partial_scans ? 180 : angle_deg;
  return ((180 - covered_deg) / 2 + 0.25 * partial) * kRadPerDeg;
}

double Lms200ScanFormat::step_rad() const {
  return partial_scans ? kRadPerDeg : resolution_cdeg / 100.0 * kRadPerDeg;
}

Lms200ScanResult decode_scan(const Lms200Telegram& telegram, const Lms200ScanFormat& format) {
  if (const char* reason = refusal(telegram, format)) return {std::nullopt, reason};
  const std::vector<std::uint8_t>& data = telegram.data;
  Lms200Scan scan;
  scan.partial = static_cast<int>(word(data, 0) >> kPartialShift & kPartialMask);
  scan.values.reserve(format.values(scan.partial));
  std::size_t at = kCountBytes;
  for (std::size_t i = 0; i < format.values(scan.partial); ++i, at += 2)
    scan.values.push_back(decode_value(word(data, at), format));
  if (format.index_bytes) {
    scan.scan_index = data[at];
    scan.telegram_index = data[at + 1];
  }
  scan.status = decode_lms200_status(data.back());
  return {std::move(scan), nullptr};
}

Lms200Telegram encode_scan(const Lms200Scan& scan, const Lms200ScanFormat& format) {
  Lms200Telegram telegram{lms200::kReply, lms200::kScan, {}};
  std::vector<std::uint8_t>& data = telegram.data;
  put_word(data, static_cast<unsigned>(scan.values.size()) |
                     static_cast<unsigned>(scan.partial) << kPartialShift |
                     (format.partial_scans ? kPartialBit : 0u) | unit_bits(format) << kUnitShift);
  for (const Lms200Value& value : scan.values) put_word(data, encode_value(value, format));
  if (format.index_bytes) {
    data.push_back(scan.scan_index);
    data.push_back(scan.telegram_index);
  }
  data.push_back(encode(scan.status));
  return telegram;
}

LaserLine to_laser_line(const Lms200Scan& scan, const Lms200ScanFormat& format,
                        std::int64_t utime_us) {
  LaserLine line;
  line.utime_us = utime_us;
  line.first_angle_rad = format.first_angle_rad(scan.partial);
  line.step_rad = format.step_rad();
  line.ranges_m.reserve(scan.values.size());
  for (std::size_t i = 0; i < scan.values.size(); ++i) {
    const Lms200Value& value = scan.values[i];
    float range_m = std::numeric_limits<float>::quiet_NaN();
    if (value.kind == Kind::kRange) range_m = static_cast<float>(value.range_m);
    if (value.kind == Kind::kOverMaximum) range_m = std::numeric_limits<float>::infinity();
    line.ranges_m.push_back(range_m);
    if (value.kind != Kind::kDazzled) continue;
    line.dazzled.resize(scan.values.size());
    line.dazzled[i] = 1;
  }
  return line;
}

std::vector<Lms200Value> to_values(const LaserLine& line) {
  std::vector<Lms200Value> values(line.ranges_m.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double range_m = line.ranges_m[i];
    if (i < line.dazzled.size() && line.dazzled[i] != 0) {
      values[i].kind = Kind::kDazzled;
    } else if (std::isinf(range_m)) {
      values[i].kind = Kind::kOverMaximum;
    } else if (!std::isnan(range_m)) {
      values[i] = {Kind::kRange, range_m, 0};
    }
  }
  return values;
}

}  // namespace voxlist::scanner
