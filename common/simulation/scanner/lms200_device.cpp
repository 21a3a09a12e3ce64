#include "voxlist/simulation/scanner/lms200_device.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "voxlist/scanner/lms200/lms200_commands.h"
#include "voxlist/scanner/lms200/lms200_reports.h"
#include "voxlist/system/check.h"

namespace voxlist::simulation {
namespace {

using Configuration = scanner::Lms200Configuration;

// How long the device takes (us). Real units: up to 60 ms for an answer, 3 s for a mode, 7 s for
// the EEPROM.
constexpr std::int64_t kAnswer_us = 1'000;
constexpr std::int64_t kModeChange_us = 30'000;
constexpr std::int64_t kEepromWrite_us = 300'000;

constexpr std::size_t kStopThreshold = 2;           // in the configuration
constexpr std::uint8_t kUsualStopThreshold = 0x46;  // as delivered
constexpr std::uint8_t kPowerOnStatus = 0x13;       // as in SICK's quick manual
constexpr std::string_view kType = "LMS200;301063;V02.06 ";
constexpr std::string_view kFirmware = "V02.06";

std::vector<std::uint8_t> bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

void put_word(std::vector<std::uint8_t>& bytes, int word) {
  bytes.push_back(static_cast<std::uint8_t>(word & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(word >> 8));
}

int mode_baud(std::uint8_t mode) {
  switch (mode) {
    case scanner::lms200::k9600Baud:
      return 9600;
    case scanner::lms200::k19200Baud:
      return 19200;
    case scanner::lms200::k38400Baud:
      return 38400;
    case scanner::lms200::k500000Baud:
      return 500000;
    default:
      return 0;
  }
}

bool has_password(const std::vector<std::uint8_t>& data) {
  const std::string_view password = scanner::lms200::kPassword;
  return std::equal(data.begin() + 1, data.end(), password.begin(), password.end());
}

}  // namespace

Lms200Device::Lms200Device(const Config& config, std::int64_t start_utime_us, MeasureLine measure)
    : config_(config),
      start_utime_us_(start_utime_us),
      now_utime_us_(start_utime_us),
      measure_(std::move(measure)),
      random_(config.seed, 1),
      parser_(scanner::plausible_lms200_request),
      line_(config.seed),
      eeprom_(config.long_configuration ? 34 : 32) {
  eeprom_[kStopThreshold] = kUsualStopThreshold;
  start_up(start_utime_us);
  if (!config.streams_at_start) return;
  power_on_utime_us_.reset();
  resolution_cdeg_ = 100;
  mode_ = scanner::lms200::kContinuous;
  begin_scans(start_utime_us);
}

void Lms200Device::start_up(std::int64_t utime_us) {
  parser_.clear();
  baud_ = config_.baud;
  mode_ = scanner::lms200::kOnRequest;
  angle_deg_ = 180;
  resolution_cdeg_ = 50;
  one_scan_ = false;
  power_on_utime_us_ = utime_us + std::llround(config_.power_on_s * 1e6);
}

void Lms200Device::power_cycle(std::int64_t utime_us) {
  advance(utime_us);
  line_.cut(utime_us);
  start_up(utime_us);
}

void Lms200Device::receive(std::int64_t utime_us, int host_baud,
                           std::span<const std::uint8_t> bytes) {
  advance(utime_us);
  if (power_on_utime_us_) return;
  const std::int64_t bad_before = parser_.counts().bad_crc;
  if (host_baud == baud_) {
    parser_.feed(utime_us, bytes);
  } else {
    parser_.feed(utime_us, garbled(bytes.size(), host_baud, baud_, random_));
  }
  if (parser_.counts().bad_crc > bad_before)
    send_byte(utime_us + kAnswer_us, scanner::kLms200Refused);
  while (const auto event = parser_.next())
    if (event->kind == scanner::Lms200Event::Kind::kTelegram) answer(utime_us, event->telegram);
}

std::vector<TimedByte> Lms200Device::sent_until(std::int64_t utime_us, int host_baud) {
  advance(utime_us);
  return line_.take(utime_us, host_baud);
}

std::optional<std::int64_t> Lms200Device::next_byte_utime_us() const {
  if (const auto next = line_.next_utime_us()) return next;
  if (faults_.silent) return std::nullopt;
  const auto event = next_event_utime_us();
  if (!event) return std::nullopt;
  return *event + std::llround(1e7 / baud_);
}

void Lms200Device::advance(std::int64_t utime_us) {
  VOXLIST_CHECK(utime_us >= now_utime_us_, "the device's time does not go back");
  now_utime_us_ = utime_us;
  for (auto event = next_event_utime_us(); event && *event <= utime_us;
       event = next_event_utime_us()) {
    if (power_on_utime_us_) {
      power_on_utime_us_.reset();
      Bytes type = bytes_of(kType);
      type.push_back(kPowerOnStatus);
      send(*event, scanner::lms200::kPoweredOn, std::move(type));
    } else {
      send_scan(*event);
    }
  }
}

std::optional<std::int64_t> Lms200Device::next_event_utime_us() const {
  if (power_on_utime_us_) return power_on_utime_us_;
  if (measures()) return scan_ready_utime_us();
  return std::nullopt;
}

void Lms200Device::answer(std::int64_t utime_us, const scanner::Lms200Telegram& request) {
  utime_us += kAnswer_us;
  if (faults_.refuse) return send_byte(utime_us, scanner::kLms200Refused);
  send_byte(utime_us, scanner::kLms200Accepted);
  switch (request.command) {
    case scanner::lms200::kReset:
      send(utime_us, scanner::lms200::kResetting, {status()});
      return start_up(std::max(utime_us, line_.free_utime_us()));
    case scanner::lms200::kSetMode:
      return set_mode(utime_us + kModeChange_us, request.data);
    case scanner::lms200::kSetVariant:
      return set_variant(utime_us, request.data);
    case scanner::lms200::kSetConfiguration:
      return write_configuration(utime_us, request.data);
    case scanner::lms200::kGetScan:
      return one_scan(utime_us);
    case scanner::lms200::kGetStatus:
      return reply(utime_us, request.command, status_report());
    case scanner::lms200::kGetErrors:
      return reply(utime_us, request.command, {});
    case scanner::lms200::kGetType:
      return reply(utime_us, request.command, bytes_of(kType));
    case scanner::lms200::kGetConfiguration:
      return reply(utime_us, request.command, eeprom_);
    default:
      return reject(utime_us);
  }
}

void Lms200Device::set_mode(std::int64_t utime_us, const Bytes& data) {
  const std::uint8_t mode = data[0];
  const int baud = mode_baud(mode);
  const bool known = baud != 0 || mode == scanner::lms200::kDiagnosis ||
                     mode == scanner::lms200::kContinuous || mode == scanner::lms200::kOnRequest ||
                     mode == scanner::lms200::kPartialScans ||
                     (mode == scanner::lms200::kInstallation && has_password(data));
  reply(utime_us, scanner::lms200::kSetMode, {static_cast<std::uint8_t>(known ? 0 : 1)});
  if (!known) return;
  if (baud != 0) {
    baud_ = baud;
  } else {
    mode_ = mode;
    one_scan_ = false;
  }
  begin_scans(utime_us);
}

// What was streaming stops.
void Lms200Device::set_variant(std::int64_t utime_us, const Bytes& data) {
  const int angle_deg = data[0] | data[1] << 8, resolution_cdeg = data[2] | data[3] << 8;
  const bool known = (resolution_cdeg == 100 || resolution_cdeg == 50 || resolution_cdeg == 25) &&
                     (angle_deg == 100 || (angle_deg == 180 && resolution_cdeg != 25));
  if (measures()) mode_ = scanner::lms200::kOnRequest;
  if (known) {
    angle_deg_ = angle_deg;
    resolution_cdeg_ = resolution_cdeg;
  }
  Bytes answer{static_cast<std::uint8_t>(known ? 1 : 0)};
  put_word(answer, angle_deg_);
  put_word(answer, resolution_cdeg_);
  reply(utime_us, scanner::lms200::kSetVariant, std::move(answer));
}

void Lms200Device::write_configuration(std::int64_t utime_us, const Bytes& data) {
  if (mode_ != scanner::lms200::kInstallation || data.size() != eeprom_.size())
    return reject(utime_us);
  scanner::Lms200ScanFormat wished;
  wished.measuring_mode = data[Configuration::kMeasuringMode];
  const bool known = wished.known_mode() && data[Configuration::kUnits] <= 1;
  if (known) {
    eeprom_ = data;
    ++configuration_writes_;
  }
  Bytes answer{static_cast<std::uint8_t>(known ? 1 : 0)};
  answer.insert(answer.end(), eeprom_.begin(), eeprom_.end());
  reply(utime_us + kEepromWrite_us, scanner::lms200::kSetConfiguration, std::move(answer));
}

void Lms200Device::one_scan(std::int64_t utime_us) {
  if (mode_ != scanner::lms200::kOnRequest) return reject(utime_us);
  one_scan_ = true;
  begin_scans(utime_us);
}

Lms200Device::Bytes Lms200Device::status_report() const {
  scanner::Lms200StatusReport report;
  report.firmware = kFirmware;
  report.mode = mode_;
  report.measuring_mode = eeprom_[Configuration::kMeasuringMode];
  report.angle_deg = angle_deg_;
  report.resolution_cdeg = resolution_cdeg_;
  report.baud = baud_;
  report.units = eeprom_[Configuration::kUnits];
  Bytes data = scanner::encode_status_report(report).data;
  data.pop_back();  // the status is every reply's
  return data;
}

std::uint8_t Lms200Device::status() const {
  scanner::Lms200Status status;
  status.polluted = faults_.pollution;
  return scanner::encode(status);
}

void Lms200Device::reply(std::int64_t utime_us, std::uint8_t request, Bytes data) {
  data.push_back(status());
  send(utime_us, request | scanner::lms200::kReply, std::move(data));
}

void Lms200Device::reject(std::int64_t utime_us) {
  send(utime_us, scanner::lms200::kRejected, {status()});
}

void Lms200Device::send(std::int64_t utime_us, std::uint8_t command, Bytes data) {
  const std::uint8_t address = faults_.address_81 ? 0x81 : 0x80;
  put_on_line(utime_us,
              scanner::encode(scanner::Lms200Telegram{address, command, std::move(data)}));
}

void Lms200Device::send_byte(std::int64_t utime_us, std::uint8_t byte) {
  put_on_line(utime_us, {byte});
}

void Lms200Device::put_on_line(std::int64_t utime_us, const Bytes& bytes) {
  if (faults_.silent) return;
  line_.send(utime_us, bytes, baud_, {faults_.drop_byte, faults_.corrupt_byte, faults_.noise_byte});
}

}  // namespace voxlist::simulation
