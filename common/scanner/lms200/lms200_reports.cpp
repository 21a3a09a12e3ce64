#include "voxlist/scanner/lms200/lms200_reports.h"

#include <array>
#include <utility>

#include "voxlist/scanner/lms200/lms200_commands.h"

namespace voxlist::scanner {
namespace {

// B1, with status. Some firmware leaves out reserved bytes behind the first nine.
constexpr std::size_t kLongReport = 153, kShortReport = 147, kCommonBytes = 9;

// Offsets in the data of a long report.
constexpr std::size_t kFirmware = 0, kFirmwareEnd = 7, kMode = 7, kDefect = 8, kMeasuringMode = 101,
                      kAngle = 106, kResolution = 108, kBaud = 115, kBaudPermanent = 118,
                      kAddress = 119, kUnits = 121, kLaserOn = 122;

constexpr std::array<std::pair<unsigned, int>, 4> kBauds{
    {{0x8067, 9600}, {0x8033, 19200}, {0x8019, 38400}, {0x8001, 500000}}};

bool is_reply(const Lms200Telegram& telegram, std::uint8_t request) {
  return telegram.command == (request | lms200::kReply) && !telegram.data.empty();
}

std::string text(const std::vector<std::uint8_t>& bytes, std::size_t first, std::size_t end) {
  std::string text(bytes.begin() + static_cast<std::ptrdiff_t>(first),
                   bytes.begin() + static_cast<std::ptrdiff_t>(end));
  text.erase(text.find_last_not_of(std::string(" \0", 2)) + 1);
  return text;
}

void put_word(std::vector<std::uint8_t>& data, std::size_t at, unsigned word) {
  data[at] = static_cast<std::uint8_t>(word & 0xFF);
  data[at + 1] = static_cast<std::uint8_t>(word >> 8 & 0xFF);
}

}  // namespace

std::optional<Lms200StatusReport> decode_status_report(const Lms200Telegram& telegram) {
  const std::vector<std::uint8_t>& data = telegram.data;
  if (!is_reply(telegram, lms200::kGetStatus) || data.size() < kShortReport) return std::nullopt;
  const std::size_t missing = data.size() < kLongReport ? kLongReport - kShortReport : 0;
  const auto byte = [&](std::size_t at) -> unsigned {
    return data[at < kCommonBytes ? at : at - missing];
  };
  const auto word = [&](std::size_t at) { return byte(at) | byte(at + 1) << 8; };
  Lms200StatusReport report;
  report.firmware = text(data, kFirmware, kFirmwareEnd);
  report.mode = static_cast<int>(byte(kMode));
  report.defect = byte(kDefect) != 0;
  report.measuring_mode = static_cast<int>(byte(kMeasuringMode));
  report.angle_deg = static_cast<int>(word(kAngle));
  report.resolution_cdeg = static_cast<int>(word(kResolution));
  report.baud = 0;
  for (const auto& [code, baud] : kBauds)
    if (word(kBaud) == code) report.baud = baud;
  report.baud_permanent = byte(kBaudPermanent) != 0;
  report.address = static_cast<int>(byte(kAddress));
  report.units = static_cast<int>(byte(kUnits));
  report.laser_on = byte(kLaserOn) != 0;
  report.status = decode_lms200_status(data.back());
  return report;
}

Lms200Telegram encode_status_report(const Lms200StatusReport& report) {
  std::vector<std::uint8_t> data(kLongReport);
  const auto put = [&](std::size_t at, int byte) { data[at] = static_cast<std::uint8_t>(byte); };
  for (std::size_t i = kFirmware; i < kFirmwareEnd; ++i)
    put(i, i < report.firmware.size() ? report.firmware[i] : ' ');
  put(kMode, report.mode);
  put(kDefect, report.defect);
  put(kMeasuringMode, report.measuring_mode);
  put_word(data, kAngle, static_cast<unsigned>(report.angle_deg));
  put_word(data, kResolution, static_cast<unsigned>(report.resolution_cdeg));
  for (const auto& [code, baud] : kBauds)
    if (baud == report.baud) put_word(data, kBaud, code);
  put(kBaudPermanent, report.baud_permanent);
  put(kAddress, report.address);
  put(kUnits, report.units);
  put(kLaserOn, report.laser_on);
  data.back() = encode(report.status);
  return {lms200::kReply, lms200::kGetStatus | lms200::kReply, std::move(data)};
}

std::optional<Lms200Configuration> decode_configuration(const Lms200Telegram& telegram) {
  if (!is_reply(telegram, lms200::kGetConfiguration)) return std::nullopt;
  return Lms200Configuration{{telegram.data.begin(), telegram.data.end() - 1}};
}

std::optional<Lms200Written> decode_written(const Lms200Telegram& telegram) {
  if (!is_reply(telegram, lms200::kSetConfiguration) || telegram.data.size() < 2)
    return std::nullopt;
  return Lms200Written{telegram.data[0] == 1,
                       {{telegram.data.begin() + 1, telegram.data.end() - 1}}};
}

std::optional<bool> decode_variant_accepted(const Lms200Telegram& telegram) {
  if (!is_reply(telegram, lms200::kSetVariant)) return std::nullopt;
  return telegram.data[0] == 1;
}

std::optional<bool> decode_mode_changed(const Lms200Telegram& telegram) {
  if (!is_reply(telegram, lms200::kSetMode)) return std::nullopt;
  return telegram.data[0] == 0;
}

std::optional<std::string> decode_type(const Lms200Telegram& telegram) {
  if (!is_reply(telegram, lms200::kGetType) && !is_reply(telegram, lms200::kPoweredOn))
    return std::nullopt;
  return text(telegram.data, 0, telegram.data.size() - 1);
}

std::optional<std::vector<Lms200Error>> decode_errors(const Lms200Telegram& telegram) {
  if (!is_reply(telegram, lms200::kGetErrors)) return std::nullopt;
  std::vector<Lms200Error> errors;
  for (std::size_t i = 0; i + 2 < telegram.data.size(); i += 2)
    errors.push_back({telegram.data[i], telegram.data[i + 1]});
  return errors;
}

}  // namespace voxlist::scanner
