#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace voxlist {

/// One telegram of the SICK LMS 2xx protocol: 02, address, length, command, data, CRC (SICK telegram
/// listing 8007954, section 4.2). Replies have bit 7 set in address and command, and their last
/// data byte is the device's status.
struct Lms200Telegram {
  std::uint8_t address = 0;
  std::uint8_t command = 0;
  std::vector<std::uint8_t> data;

  bool operator==(const Lms200Telegram&) const = default;
};

/// Longest telegram: 401 values with both index bytes.
inline constexpr std::size_t kMaxLms200TelegramBytes = 814;

/// SICK's own checksum of all bytes before it (section 9; one shift a byte, no CRC-16 of others).
std::uint16_t lms200_crc(std::span<const std::uint8_t> bytes);

/// The telegram's bytes, with length and CRC.
std::vector<std::uint8_t> encode(const Lms200Telegram& telegram);

/// What came from the device: a telegram, or one of its bytes outside of telegrams.
struct Lms200Event {
  enum class Kind { kTelegram, kAccepted, kRefused };  ///< telegram, 06, 15

  Kind kind = Kind::kTelegram;
  Lms200Telegram telegram;

  /// When the event's first byte arrived: the time of the piece that it came in, microseconds.
  std::int64_t utime_us = 0;
};

/// Finds telegrams in a stream that may have lost, damaged and invented bytes. After a bad length
/// or CRC it goes on one byte later, so that no whole telegram behind the damage is missed.
class Lms200Parser {
 public:
  /// Whether a telegram that starts like this can be one: its command and data length.
  using Plausible = bool (*)(std::uint8_t command, std::size_t data_bytes);

  /// Replies of the device only (host's requests are refused), of lengths that the protocol knows.
  Lms200Parser();

  /// The same for another party: a device that reads its host.
  explicit Lms200Parser(Plausible plausible);

  /// Takes bytes that arrived at a time. A telegram that is not complete a while after its last
  /// byte (kGap_us) is given up.
  void feed(std::int64_t utime_us, std::span<const std::uint8_t> bytes);

  /// The next event; nothing until more bytes come. 06 and 15 are events only where no telegram is
  /// under way.
  std::optional<Lms200Event> next();

  /// Forgets what is under way (after a change of speed).
  void clear();

  struct Counts {
    std::int64_t telegrams = 0;
    std::int64_t bad_crc = 0;        ///< candidates of plausible length
    std::int64_t skipped_bytes = 0;  ///< that belong to no event
    std::int64_t torn = 0;           ///< telegrams that stopped in the middle
  };
  const Counts& counts() const { return counts_; }

 private:
  // Left to the implementation.
  Plausible plausible_;
  std::deque<std::pair<std::int64_t, std::uint8_t>> bytes_;
  Counts counts_;
};

}  // namespace voxlist
