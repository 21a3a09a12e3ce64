// The half of the simulated LMS 200 that measures: when its mirror turns, and what its scans hold.
#include <cmath>
#include <numbers>
#include <utility>

#include "voxlist/scanner/lms200/lms200_commands.h"
#include "voxlist/scanner/lms200/lms200_reports.h"
#include "voxlist/simulation/scanner/lms200_device.h"

namespace voxlist::simulation {
namespace {

using Configuration = scanner::Lms200Configuration;

constexpr double kRadPerQuarter = std::numbers::pi / 720.0;
constexpr double kQuartersPerTurn = 1440.0;
constexpr std::uint8_t kDazzleFlag = 4;      // of values in measuring mode 0
constexpr std::uint8_t kPartialBits = 0x28;  // number 1, in the count's high byte
constexpr std::size_t kBeams = 181;

}  // namespace

scanner::Lms200ScanFormat Lms200Device::format() const {
  scanner::Lms200ScanFormat format;
  format.measuring_mode = eeprom_[Configuration::kMeasuringMode];
  format.millimetres = (eeprom_[Configuration::kUnits] == 1) != faults_.wrong_unit;
  format.angle_deg = angle_deg_;
  format.resolution_cdeg = resolution_cdeg_;
  format.partial_scans = mode_ == scanner::lms200::kPartialScans;
  format.index_bytes = (eeprom_[Configuration::kAvailability] & Configuration::kIndexBytes) != 0;
  return format;
}

bool Lms200Device::measures() const {
  return one_scan_ || mode_ == scanner::lms200::kContinuous ||
         mode_ == scanner::lms200::kPartialScans;
}

int Lms200Device::turns_per_scan() const {
  return mode_ == scanner::lms200::kPartialScans ? 1 : interlaced_turns();
}

std::int64_t Lms200Device::turn_utime_us(double turn) const {
  return start_utime_us_ + std::llround(turn * 1e6 / config_.turns_per_second);
}

// The first scan is the first whole one behind all that was sent before.
void Lms200Device::begin_scans(std::int64_t utime_us) {
  const std::int64_t since_us = std::max(utime_us, line_.free_utime_us()) - start_utime_us_;
  next_turn_ = static_cast<std::int64_t>(
      std::ceil(static_cast<double>(since_us) * 1e-6 * config_.turns_per_second));
}

std::int64_t Lms200Device::scan_ready_utime_us() const {
  return turn_utime_us(static_cast<double>(next_turn_ + turns_per_scan()) - 0.5);
}

void Lms200Device::send_scan(std::int64_t utime_us) {
  const bool line_is_free = line_.free_utime_us() <= utime_us;
  if (line_is_free && !faults_.silent) {
    scanner::Lms200Telegram telegram = scanner::encode_scan(measured_scan(), format());
    if (faults_.partial_bits && mode_ != scanner::lms200::kPartialScans)
      telegram.data[1] |= kPartialBits;
    send(utime_us, telegram.command, std::move(telegram.data));
  }
  one_scan_ = false;
  next_turn_ += turns_per_scan();
}

scanner::Lms200Scan Lms200Device::measured_scan() {
  const scanner::Lms200ScanFormat as = format();
  const std::int64_t last_turn = next_turn_ + turns_per_scan() - 1;
  const int step_quarters = resolution_cdeg_ / 25;
  scanner::Lms200Scan scan;
  if (as.partial_scans) {
    scan.partial = static_cast<int>(next_turn_ % interlaced_turns()) * step_quarters;
    scan.values = measured(next_turn_, scan.partial);
    scan.values.resize(as.values(scan.partial));
  } else {
    std::vector<std::vector<scanner::Lms200Value>> turns;
    for (std::int64_t turn = next_turn_; turn <= last_turn; ++turn)
      turns.push_back(measured(turn, static_cast<int>(turn - next_turn_) * step_quarters));
    const std::size_t first = static_cast<std::size_t>(180 - angle_deg_) / 2 * turns.size();
    for (std::size_t i = first; i < first + as.values(0); ++i)
      scan.values.push_back(turns[i % turns.size()][i / turns.size()]);
  }
  inject(scan.values);
  scan.scan_index = static_cast<std::uint8_t>(last_turn & 0xFF);
  scan.telegram_index = telegram_index_++;
  scan.status = scanner::decode_lms200_status(status());
  return scan;
}

// Always 181 values: those that were not measured are invalid.
std::vector<scanner::Lms200Value> Lms200Device::measured(std::int64_t turn, int quarters) const {
  const std::int64_t utime_us =
      turn_utime_us(static_cast<double>(turn) + quarters / kQuartersPerTurn);
  std::vector<scanner::Lms200Value> values =
      scanner::to_values(measure_(utime_us, quarters * kRadPerQuarter));
  values.resize(kBeams);
  return values;
}

void Lms200Device::inject(std::vector<scanner::Lms200Value>& values) {
  const auto happens = [&](double probability) {
    return probability > 0.0 && random_.uniform(0.0, 1.0) < probability;
  };
  const bool has_dazzle_bit = eeprom_[Configuration::kMeasuringMode] == 0;
  for (scanner::Lms200Value& value : values) {
    if (happens(faults_.over_max)) value = {scanner::Lms200Value::Kind::kOverMaximum, 0.0, 0};
    if (!happens(faults_.dazzle)) continue;
    if (has_dazzle_bit && happens(0.5)) {
      value.flags = kDazzleFlag;
    } else {
      value = {scanner::Lms200Value::Kind::kDazzled, 0.0, 0};
    }
  }
}

}  // namespace voxlist::simulation
