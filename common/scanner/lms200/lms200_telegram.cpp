#include "voxlist/scanner/lms200/lms200_telegram.h"

#include <fmt/core.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace voxlist::scanner {
namespace {

constexpr std::uint8_t kStart = 0x02;
constexpr std::size_t kHeaderBytes = 4;  // start, address, length
constexpr std::size_t kCrcBytes = 2;
constexpr std::size_t kMaxValues = 401;
constexpr std::size_t kMaxErrors = 64;
constexpr std::uint8_t kReplyBit = 0x80;

std::size_t word(std::span<const std::uint8_t> bytes, std::size_t at) {
  return bytes[at] | static_cast<std::size_t>(bytes[at + 1]) << 8;
}

bool within(std::size_t n, std::size_t low, std::size_t high) { return n >= low && n <= high; }

// `fixed` bytes and values of two; perhaps two index bytes, which look like one value more.
bool holds_values(std::size_t data_bytes, std::size_t fixed) {
  return within(data_bytes, fixed + 2, fixed + 2 * kMaxValues + 2) && (data_bytes - fixed) % 2 == 0;
}

// Units use 0 and 1 for themselves; direction and command agree on which way a telegram goes.
bool plausible_address(std::uint8_t address) { return (address & ~kReplyBit) <= 1; }
bool same_direction(std::uint8_t address, std::uint8_t command) {
  return ((address ^ command) & kReplyBit) == 0;
}

}  // namespace

std::uint16_t lms200_crc(std::span<const std::uint8_t> bytes) {
  unsigned crc = 0, previous = 0;
  for (const std::uint8_t byte : bytes) {
    const bool carry = (crc & 0x8000u) != 0;
    crc = (crc << 1) & 0xFFFFu;
    if (carry) crc ^= 0x8005u;
    crc ^= previous << 8 | byte;
    previous = byte;
  }
  return static_cast<std::uint16_t>(crc);
}

std::vector<std::uint8_t> encode(const Lms200Telegram& telegram) {
  const std::size_t length = telegram.data.size() + 1;
  if (kHeaderBytes + length + kCrcBytes > kMaxLms200TelegramBytes)
    throw std::invalid_argument(fmt::format("a telegram cannot have {} bytes", length));
  std::vector<std::uint8_t> bytes;
  bytes.reserve(kMaxLms200TelegramBytes);
  for (const std::size_t byte : {std::size_t{kStart}, std::size_t{telegram.address}, length & 0xFF,
                                 length >> 8, std::size_t{telegram.command}})
    bytes.push_back(static_cast<std::uint8_t>(byte));
  bytes.insert(bytes.end(), telegram.data.begin(), telegram.data.end());
  const std::uint16_t crc = lms200_crc(bytes);
  bytes.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
  return bytes;
}

bool plausible_lms200_reply(std::uint8_t command, std::size_t n) {
  switch (command) {
    case 0x90:  // power on
    case 0xBA:  // type
      return within(n, 8, 40);
    case 0x91:  // reset
    case 0x92:  // rejected
      return n == 1;
    case 0xA0:  // mode
      return n == 2;
    case 0xB0:  // values: count, values, status
      return holds_values(n, 3);
    case 0xB1:  // status
      return within(n, 124, 160);
    case 0xB2:  // errors: pairs, status
      return n % 2 == 1 && n <= 2 * kMaxErrors + 1;
    case 0xB6:  // mean values
      return holds_values(n, 4);
    case 0xB7:  // values of a sub-range
      return holds_values(n, 7);
    case 0xBB:  // variant
      return n == 6;
    case 0xF4:  // configuration, 32 or 34 bytes in the units that are known
      return within(n, 31, 37);
    case 0xF7:  // configuration was written
      return within(n, 32, 38);
    default:
      return false;
  }
}

bool plausible_lms200_request(std::uint8_t command, std::size_t n) {
  switch (command) {
    case 0x10:  // reset
    case 0x31:  // status
    case 0x32:  // errors
    case 0x3A:  // type
    case 0x74:  // configuration
      return n == 0;
    case 0x20:  // mode, perhaps with a password
      return within(n, 1, 9);
    case 0x30:  // values
    case 0x36:  // mean values
    case 0x66:  // permanent speed
      return n == 1;
    case 0x3B:  // variant
      return n == 4;
    case 0x77:  // write the configuration
      return within(n, 30, 36);
    default:
      return false;
  }
}

Lms200Parser::Lms200Parser() : Lms200Parser(plausible_lms200_reply) {}

Lms200Parser::Lms200Parser(Plausible plausible) : plausible_(plausible) {}

void Lms200Parser::feed(std::int64_t utime_us, std::span<const std::uint8_t> bytes) {
  if (utime_us - last_utime_us_ > kGap_us) give_up();
  if (bytes.empty()) return;
  last_utime_us_ = utime_us;
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(head_));
  done_bytes_ += static_cast<std::int64_t>(std::exchange(head_, 0));
  pieces_.push_back({done_bytes_ + static_cast<std::int64_t>(bytes_.size()), utime_us});
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  parse();
  forget_old_pieces();
}

std::optional<Lms200Event> Lms200Parser::next() {
  if (events_.empty()) return std::nullopt;
  Lms200Event event = std::move(events_.front());
  events_.pop_front();
  return event;
}

void Lms200Parser::clear() {
  head_ = bytes_.size();
  behind_event_ = true;
  events_.clear();
}

void Lms200Parser::parse() {
  while (head_ < bytes_.size()) {
    const std::uint8_t byte = bytes_[head_];
    if (byte == kStart) {
      const Candidate found = candidate();
      if (found == Candidate::kIncomplete) return;
      if (found == Candidate::kNone) skip_byte();
    } else if (byte == kLms200Accepted && behind_event_) {
      take(Lms200Event::Kind::kAccepted, 1);
    } else if (byte == kLms200Refused && behind_event_) {
      take(Lms200Event::Kind::kRefused, 1);
    } else {
      skip_byte();
    }
  }
}

Lms200Parser::Candidate Lms200Parser::candidate() {
  const auto rest = std::span(bytes_).subspan(head_);
  if (rest.size() > 1 && !plausible_address(rest[1])) return Candidate::kNone;
  if (rest.size() <= kHeaderBytes) return Candidate::kIncomplete;
  const std::size_t length = word(rest, 2);
  const std::uint8_t command = rest[kHeaderBytes];
  if (length == 0 || !same_direction(rest[1], command) || !plausible_(command, length - 1))
    return Candidate::kNone;
  const std::size_t crc_at = kHeaderBytes + length;
  if (rest.size() < crc_at + kCrcBytes) return Candidate::kIncomplete;
  if (lms200_crc(rest.first(crc_at)) != word(rest, crc_at)) {
    ++counts_.bad_crc;
    return Candidate::kNone;
  }
  ++counts_.telegrams;
  take(Lms200Event::Kind::kTelegram, crc_at + kCrcBytes);
  return Candidate::kWhole;
}

// What waits for bytes is no telegram, but there may be whole ones behind its first byte.
void Lms200Parser::give_up() {
  if (head_ < bytes_.size()) ++counts_.torn;
  while (head_ < bytes_.size()) {
    skip_byte();
    parse();
  }
  behind_event_ = true;
}

void Lms200Parser::skip_byte() {
  ++counts_.skipped_bytes;
  ++head_;
  behind_event_ = false;
}

void Lms200Parser::take(Lms200Event::Kind kind, std::size_t bytes) {
  Lms200Event event;
  event.kind = kind;
  forget_old_pieces();
  event.utime_us = pieces_.front().utime_us;
  if (kind == Lms200Event::Kind::kTelegram) {
    const auto all = std::span(bytes_).subspan(head_, bytes - kCrcBytes);
    const auto data = all.subspan(kHeaderBytes + 1);
    event.telegram = {all[1], all[kHeaderBytes], {data.begin(), data.end()}};
  }
  events_.push_back(std::move(event));
  head_ += bytes;
  behind_event_ = true;
}

void Lms200Parser::forget_old_pieces() {
  const std::int64_t head = done_bytes_ + static_cast<std::int64_t>(head_);
  while (pieces_.size() > 1 && pieces_[1].first <= head) pieces_.pop_front();
}

}  // namespace voxlist::scanner
