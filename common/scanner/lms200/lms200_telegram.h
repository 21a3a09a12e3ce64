#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace voxlist::scanner {

/// One telegram of the SICK LMS 2xx protocol: 02, address, length, command, data, CRC (SICK
/// telegram listing 8007954, section 4.2). Replies have bit 7 set in address and command, and their
/// last data byte is the device's status.
struct Lms200Telegram {
  std::uint8_t address = 0;
  std::uint8_t command = 0;
  std::vector<std::uint8_t> data;

  bool operator==(const Lms200Telegram&) const = default;
};

/// Longest telegram: 401 values with both index bytes.
inline constexpr std::size_t kMaxLms200TelegramBytes = 814;

/// The bytes outside of telegrams: a request was understood, or was not.
inline constexpr std::uint8_t kLms200Accepted = 0x06;
inline constexpr std::uint8_t kLms200Refused = 0x15;

/// SICK's own checksum of all bytes before it (section 9; one shift a byte, no CRC-16 of others).
std::uint16_t lms200_crc(std::span<const std::uint8_t> bytes);

/// The telegram's bytes, with length and CRC.
std::vector<std::uint8_t> encode(const Lms200Telegram& telegram);

/// Whether a device's reply, or a host's request, of this command can have so many data bytes.
bool plausible_lms200_reply(std::uint8_t command, std::size_t data_bytes);
bool plausible_lms200_request(std::uint8_t command, std::size_t data_bytes);

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
  /// A telegram whose next byte does not come for so long is torn. The device leaves at most 14 ms
  /// between bytes; USB adapters and a busy host add theirs.
  static constexpr std::int64_t kGap_us = 100'000;

  /// Whether a telegram that starts like this can be one: its command and data length.
  using Plausible = bool (*)(std::uint8_t command, std::size_t data_bytes);

  /// Replies of the device only (host's requests are refused), of lengths that the protocol knows.
  Lms200Parser();

  /// The same for another party: a device that reads its host.
  explicit Lms200Parser(Plausible plausible);

  /// Takes bytes that arrived at a time. A telegram that is not complete a while after its last
  /// byte (kGap_us) is given up; no bytes at all only tell the time.
  void feed(std::int64_t utime_us, std::span<const std::uint8_t> bytes);

  /// Nobody looked until this time: what comes next may have waited, and tears no telegram.
  void excuse(std::int64_t utime_us) { last_utime_us_ = utime_us; }

  /// The next event; nothing until more bytes come. 06 and 15 are events only right behind another
  /// event or after silence (kGap_us, clear): elsewhere they are data of a telegram whose beginning
  /// was lost. So a damaged line can cost an answer's 06: the reply behind it says the same.
  std::optional<Lms200Event> next();

  /// Forgets what is under way and what was not taken (after a change of speed).
  void clear();

  struct Counts {
    std::int64_t telegrams = 0;
    std::int64_t bad_crc = 0;        ///< candidates of plausible length
    std::int64_t skipped_bytes = 0;  ///< that belong to no event
    std::int64_t torn = 0;           ///< telegrams that stopped in the middle
  };
  const Counts& counts() const { return counts_; }

 private:
  // Bytes from `first` of the stream on came at a time.
  struct Piece {
    std::int64_t first, utime_us;
  };
  enum class Candidate { kWhole, kIncomplete, kNone };

  void parse();
  Candidate candidate();
  void give_up();
  void skip_byte();
  void take(Lms200Event::Kind kind, std::size_t bytes);
  void forget_old_pieces();

  Plausible plausible_;
  std::vector<std::uint8_t> bytes_;
  std::size_t head_ = 0;            // of bytes_: all before it is done with
  std::int64_t done_bytes_ = 0;     // of the stream, before bytes_
  bool behind_event_ = true;        // no byte was skipped since the last event or silence
  std::deque<Piece> pieces_;        // those that bytes_ came in
  std::int64_t last_utime_us_ = 0;  // of the last byte
  std::deque<Lms200Event> events_;
  Counts counts_;
};

}  // namespace voxlist::scanner
