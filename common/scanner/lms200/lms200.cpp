#include "voxlist/scanner/lms200/lms200.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "voxlist/scanner/lms200/lms200_commands.h"

namespace voxlist::scanner {
namespace {

// A session ends when no good scan came for so long (us): 75 scans at 500 kbaud. On a slow line,
// where one scan of 372 bytes takes 0.4 s at 9600 baud, it ends after the time of kSilentScans.
constexpr std::int64_t kSilence_us = 1'000'000;
constexpr int kSilentScans = 4;

// The scan clock rests on the arrivals of so long (us), and on no fewer than so many scans. A
// longer window averages more jitter and follows the motor's drift later.
constexpr double kWindow_us = 20e6, kWindowScans = 500.0;

// The line is in doubt after damage: the CRC is weak (one shift a byte), so on a bad line a wrong
// scan can pass it. Each damaged scan adds kDamageDoubt, each good one takes one away, up to
// kMostDoubt. Doubt grows where more than one scan in 16 is damaged, and from kTooMuchDoubt on
// scans are refused. A session starts at kMostDoubt, so its first 15 scans are refused.
constexpr int kDamageDoubt = 15, kGoodDoubt = -1, kTooMuchDoubt = 60, kMostDoubt = 75;

// Wait (us) for an answer at the end of a session, which nobody reads: only so that the next
// command is not sent into it.
constexpr std::int64_t kAnswer_us = 100'000;

const Lms200Config& checked(const Lms200Config& config) {
  if (const std::string wrong = why_invalid(config); !wrong.empty())
    throw std::invalid_argument(wrong);
  return config;
}

// A whole partial scan with what is around its values.
double scan_bits(const Lms200ScanFormat& format) {
  return 10.0 * (2.0 * static_cast<double>(format.values(0)) + 12.0);
}

int turns_per_scan(const Lms200ScanFormat& format, int baud) {
  return static_cast<int>(std::ceil(scan_bits(format) * 1e6 / baud / kLaserTurn_us));
}

}  // namespace

Lms200::Lms200(serial::Port& port, const Lms200Config& config, std::stop_token stop)
    : config_(checked(config)), link_(port, config.port, std::move(stop)), setup_(link_, config_) {}

void Lms200::fail(const std::string& what, bool silent) const {
  throw Lms200Failure(fmt::format("the LMS 200 on {} {}", config_.port, what), silent);
}

void Lms200::begin() {
  close_clock();
  format_ = setup_.run();
  const int turns = turns_per_scan(format_, link_.baud());
  clock_.emplace(ScanClockConfig{
      .delay_us = config_.delay_ms * 1e3 + 10e6 / link_.baud(),
      .turns_per_scan = turns,
      .window_s = std::max(kWindow_us, kWindowScans * turns * kLaserTurn_us) / 1e6});
  silent_us_ = 0;
  good_skipped_ = link_.counts().skipped_bytes;
  refused_in_row_ = 0;
  doubt_ = kMostDoubt;
  last_refusal_.clear();
}

std::optional<LaserLine> Lms200::next(std::int64_t timeout_us) {
  timeout_us = std::min(timeout_us, kSilence_us);
  const std::int64_t start_us = link_.now_us();
  while (const auto event = link_.event(start_us + timeout_us)) {
    if (event->kind != Lms200Event::Kind::kTelegram) continue;
    if (auto line = take(*event)) return line;
  }
  // Bounded by the timeout, because the clock may be set while it waits.
  silent_us_ += std::clamp<std::int64_t>(link_.now_us() - start_us, 0, timeout_us);
  check_stream();
  return std::nullopt;
}

std::optional<LaserLine> Lms200::take(const Lms200Event& event) {
  if (event.telegram.command == lms200::kPoweredOn) fail("restarted by itself; check its supply");
  if (event.telegram.command != lms200::kScan) return std::nullopt;
  const Lms200ScanResult result = decode_scan(event.telegram, format_);
  if (!result.scan) {
    refuse(result.refused);
    ++refused_in_row_;
    return std::nullopt;
  }
  LaserLine line = to_laser_line(*result.scan, format_, stamp(event, *result.scan));
  doubt_ = std::max(doubt_ + kGoodDoubt, 0);
  if (doubt_ >= kTooMuchDoubt) {
    refuse("line_in_doubt");
    return std::nullopt;
  }
  report_.dazzled_beams += std::ranges::count(line.dazzled, 1);
  report_.polluted = result.scan->status.polluted;
  ++report_.lines;
  return line;
}

void Lms200::refuse(const std::string& reason) {
  ++report_.refused[reason];
  last_refusal_ = reason;
}

std::int64_t Lms200::stamp(const Lms200Event& event, const Lms200Scan& scan) {
  const auto index = format_.index_bytes ? std::optional(scan.scan_index) : std::nullopt;
  const int lost = lost_in_stream(event.telegram.data.size());
  const std::int64_t turn_us = clock_->first_beam_utime_us(event.utime_us, index, lost);
  silent_us_ = 0;
  // A partial scan begins some quarters of a degree after the turn does.
  return turn_us + std::llround(scan.partial * 0.25 / 360.0 * clock_->turn_us());
}

// Scans that came damaged or made no sense since the last good one.
int Lms200::lost_in_stream(std::size_t scan_bytes) {
  const std::int64_t skipped =
      link_.counts().skipped_bytes - std::exchange(good_skipped_, link_.counts().skipped_bytes);
  const double torn = static_cast<double>(skipped) / static_cast<double>(scan_bytes);
  const int damaged = static_cast<int>(std::lround(torn));
  if (skipped > 0) doubt_ = std::min(doubt_ + kDamageDoubt * std::max(damaged, 1), kMostDoubt);
  last_refusal_.clear();
  return damaged + std::exchange(refused_in_row_, 0);
}

void Lms200::check_stream() const {
  const auto scan_us = static_cast<std::int64_t>(scan_bits(format_) * 1e6 / link_.baud());
  if (silent_us_ < std::max(kSilence_us, kSilentScans * scan_us)) return;
  if (!last_refusal_.empty())
    fail(fmt::format("sends scans that make no sense ({})", last_refusal_));
  fail(link_.counts().skipped_bytes == good_skipped_
           ? "fell silent; check its power and cable"
           : "sends nothing that can be read; check cable and earth",
       true);
}

void Lms200::close_clock() {
  if (!clock_) return;
  report_.lost_scans += clock_->lost_scans();
  report_.clock_jumps += clock_->jumps();
  clock_.reset();
}

void Lms200::end() noexcept try {
  close_clock();
  link_.ignore_stop();
  if (!setup_.found()) return;
  for (const std::uint8_t mode : {lms200::kOnRequest, lms200::k9600Baud}) {
    link_.send(lms200::kSetMode, {&mode, 1});
    link_.wait(kAnswer_us);
  }
} catch (const std::exception&) {
  // The port is gone, and with it whoever should have been told.
}

Lms200Report Lms200::report() const {
  Lms200Report report = report_;
  report.type = setup_.type();
  report.damaged = link_.counts().bad_crc + link_.counts().torn;
  if (!clock_) return report;
  report.lost_scans += clock_->lost_scans();
  report.clock_jumps += clock_->jumps();
  report.jitter_us = clock_->jitter_us();
  report.turns_per_second = 1e6 / clock_->turn_us();
  return report;
}

}  // namespace voxlist::scanner
