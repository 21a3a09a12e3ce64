#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>
#include <unordered_set>

#include "tests/temporary_folder.h"
#include "voxlist/scanner/lms200/lms200_commands.h"
#include "voxlist/scanner/lms200/lms200_reports.h"
#include "voxlist/scanner/lms200/lms200_scan.h"
#include "voxlist/serial/pseudo_terminal.h"
#include "voxlist/serial/serial_port.h"
#include "voxlist/simulation/random.h"
#include "voxlist/simulation/scanner/lms200_device.h"

// How often may a damaged telegram pass for a scan?
//
// The checksum is linear, and shifts by one bit a byte. So a byte's contribution is
// b(x) (x + x^8) x^n modulo g(x) = (x + 1)(x^15 + x + 1), but for the last byte, the status, which
// has not entered its second half yet and contributes b(x). Two consequences:
// 1. x + x^8 is a multiple of x + 1, as is g: what the bytes before the status contribute has even
//    parity. When status and checksum are intact, only 15 of the 16 bits tell anything, and damage
//    that is spread at random passes with probability 2^-15. (Random bytes instead of the checksum:
//    2^-16.)
// 2. Bit k of a byte and bit k + 1 of the byte behind it contribute the same. Of all ways to flip
//    two bits about 28 of 32 n pass, n the number of bytes: 1 in 432 of a scan with 181 values. No
//    reader of this protocol can tell such a scan from a good one.
// Count, unit, length and status are checked besides, so these are upper bounds.

namespace voxlist::scanner {
namespace {

using test::TemporaryFolder;

using Bytes = std::vector<std::uint8_t>;

constexpr double kPasses = 0x1p-15;

// VOXLIST_FUZZ_BYTES: how much is tried in all, 1 million unless told otherwise.
std::size_t fuzz_bytes() {
  const char* wished = std::getenv("VOXLIST_FUZZ_BYTES");
  return (wished != nullptr ? std::strtoull(wished, nullptr, 10) : 1'000'000) / 4;
}

std::string text(const Lms200Telegram& telegram) {
  return {telegram.data.begin(), telegram.data.end()};
}

// Six standard deviations of a Poisson number, and a few.
double at_most(double expected) { return expected + 6.0 * std::sqrt(expected) + 3.0; }

struct Fuzz {
  Fuzz(std::uint64_t seed, const Lms200ScanFormat& of) : random(seed), format(of) {
    std::cout << "seed " << seed << '\n';
  }

  std::size_t below(std::size_t limit) { return random.bits() % limit; }
  std::uint8_t any_byte() { return static_cast<std::uint8_t>(random.bits() & 0xFF); }

  // A scan that was never sent before; ranges change little from beam to beam.
  Bytes scan() {
    Lms200Scan scan;
    double range_m = random.uniform(0.1, 8.0);
    for (std::size_t i = 0; i < format.values(0); ++i) {
      range_m = std::clamp(range_m + random.uniform(-0.1, 0.1), 0.0, 8.5);
      scan.values.push_back({Lms200Value::Kind::kRange, range_m, 0});
    }
    const Lms200Telegram telegram = encode_scan(scan, format);
    sent.insert(text(telegram));
    return encode(telegram);
  }

  void flip(Bytes& bytes, std::size_t bit) {
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ 1u << bit % 8);
  }

  void flip_two(Bytes& bytes) {
    const std::size_t bits = bytes.size() * 8, first = below(bits);
    flip(bytes, first);
    flip(bytes, (first + 1 + below(bits - 1)) % bits);
  }

  // Anything but flips of two bits.
  void damage(Bytes& bytes) {
    const auto at = [&](std::size_t i) { return bytes.begin() + static_cast<std::ptrdiff_t>(i); };
    const std::size_t begin = below(bytes.size());
    const std::size_t n = 1 + below(std::min<std::size_t>(bytes.size() - begin, 40));
    switch (below(6)) {
      case 0:  // drop
        bytes.erase(at(begin), at(begin + n));
        break;
      case 1: {  // insert
        Bytes some(n);
        for (std::uint8_t& byte : some) byte = any_byte();
        bytes.insert(at(begin), some.begin(), some.end());
        break;
      }
      case 2: {  // duplicate
        const Bytes some(at(begin), at(begin + n));
        bytes.insert(at(begin), some.begin(), some.end());
        break;
      }
      case 3:  // truncate
        bytes.resize(begin);
        break;
      case 4:  // flip all over
        for (std::size_t i = 0; i < 5 + n; ++i) flip(bytes, below(bytes.size() * 8));
        break;
      default:  // overwrite
        for (std::size_t i = begin; i < begin + n; ++i) bytes[i] = any_byte();
    }
  }

  // A stream in which every other scan is whole.
  template <class Damage>
  Bytes stream(std::size_t least_bytes, Damage damage_one) {
    Bytes all;
    while (all.size() < least_bytes) {
      const Bytes whole = scan();
      Bytes damaged = scan();
      const Bytes before = damaged;
      damage_one(damaged);
      all.insert(all.end(), whole.begin(), whole.end());
      all.insert(all.end(), damaged.begin(), damaged.end());
      whole_scans += damaged == before ? 2 : 1;
      damaged_scans += damaged == before ? 0 : 1;
    }
    return all;
  }

  void feed(std::span<const std::uint8_t> bytes) {
    parser.feed(0, bytes);
    take();
  }

  void feed_in_pieces(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
      const std::size_t n = std::min(1 + below(700), bytes.size());
      feed(bytes.first(n));
      bytes = bytes.subspan(n);
    }
    finish();
  }

  void finish() {
    parser.feed(2 * Lms200Parser::kGap_us, {});
    take();
  }

  void take() {
    while (const auto event = parser.next()) {
      if (event->kind != Lms200Event::Kind::kTelegram) continue;
      if (!decode_scan(event->telegram, format).scan) continue;
      ++(sent.contains(text(event->telegram)) ? found : invented);
    }
  }

  // Whole scans are lost only to an invented one that they were a part of.
  void expect_all_whole_scans_found() const { EXPECT_GE(found + 3 * invented, whole_scans); }

  void tell(const char* what, double allowed) const {
    std::cout << what << ": " << parser.counts().skipped_bytes << " bytes skipped, "
              << parser.counts().bad_crc << " wrong checksums, " << found << " of " << whole_scans
              << " whole scans found, " << invented << " of " << damaged_scans
              << " damaged ones accepted, " << allowed << " allowed\n";
  }

  simulation::Random random;
  Lms200ScanFormat format;
  Lms200Parser parser;
  std::unordered_set<std::string> sent;  // their data
  std::int64_t whole_scans = 0, damaged_scans = 0, found = 0, invented = 0;
};

// The share of pairs of flipped bits that the checksum does not see: those whose syndromes are
// equal.
double share_of_unseen_pairs(std::size_t telegram_bytes) {
  std::map<unsigned, double> bits_with;
  for (std::size_t bit = 0; bit < telegram_bytes * 8; ++bit) {
    Bytes error(telegram_bytes);
    error[bit / 8] = static_cast<std::uint8_t>(1u << bit % 8);
    const std::size_t crc_at = telegram_bytes - 2;
    const unsigned stored = error[crc_at] | static_cast<unsigned>(error[crc_at + 1]) << 8;
    ++bits_with[lms200_crc(std::span(error).first(crc_at)) ^ stored];
  }
  double unseen = 0.0;
  for (const auto& [syndrome, n] : bits_with) unseen += n * (n - 1.0) / 2.0;
  const double bits = static_cast<double>(telegram_bytes) * 8.0;
  return unseen / (bits * (bits - 1.0) / 2.0);
}

TEST(Lms200Fuzz, OfTwoFlippedBitsTheChecksumMissesOneIn432) {
  EXPECT_NEAR(1.0 / share_of_unseen_pairs(372), 432.0, 1.0);
}

TEST(Lms200Fuzz, TwoFlippedBitsPassAsOftenAsTheChecksumAllows) {
  Fuzz fuzz(1, {});
  const Bytes stream = fuzz.stream(fuzz_bytes(), [&](Bytes& bytes) { fuzz.flip_two(bytes); });
  fuzz.feed_in_pieces(stream);
  const double allowed =
      at_most(static_cast<double>(fuzz.damaged_scans) * share_of_unseen_pairs(372));
  fuzz.tell("two bits", allowed);
  EXPECT_LE(static_cast<double>(fuzz.invented), allowed);
  fuzz.expect_all_whole_scans_found();
}

TEST(Lms200Fuzz, OtherDamagePassesNoOftenerThanFifteenBitsAllow) {
  Lms200ScanFormat partial;
  partial.partial_scans = true;
  partial.index_bytes = true;
  Lms200ScanFormat fine;
  fine.angle_deg = 100;
  fine.resolution_cdeg = 25;
  fine.millimetres = false;
  for (const Lms200ScanFormat& format : {Lms200ScanFormat{}, partial, fine}) {
    Fuzz fuzz(2, format);
    const Bytes stream = fuzz.stream(fuzz_bytes() / 3, [&](Bytes& bytes) { fuzz.damage(bytes); });
    fuzz.feed_in_pieces(stream);
    const double allowed =
        at_most(static_cast<double>(fuzz.parser.counts().bad_crc + fuzz.invented) * kPasses);
    fuzz.tell("damage", allowed);
    EXPECT_LE(static_cast<double>(fuzz.invented), allowed);
    fuzz.expect_all_whole_scans_found();
  }
}

TEST(Lms200Fuzz, RandomBytesAreNoScans) {
  Fuzz fuzz(3, {});
  Bytes bytes(fuzz_bytes());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    // Half of them from few bytes, that telegrams begin with: else hardly one would look like one.
    const Bytes frequent{0x02, 0x80, 0x81, 0x6E, 0x01, 0xB0, 0xB5, 0x40, 0x10, 0x06};
    const bool likely = i / 1000 % 2 == 0;
    bytes[i] = likely ? frequent[fuzz.below(frequent.size())] : fuzz.any_byte();
    if (i >= 7 && fuzz.below(500) == 0) {
      const Bytes head{0x02, 0x80, 0x6E, 0x01, 0xB0, 0xB5, 0x40};
      std::copy(head.begin(), head.end(), bytes.begin() + static_cast<std::ptrdiff_t>(i) - 7);
    }
  }
  fuzz.feed_in_pieces(bytes);
  const double allowed = at_most(static_cast<double>(fuzz.parser.counts().bad_crc) * kPasses);
  fuzz.tell("random", allowed);
  EXPECT_GT(fuzz.parser.counts().bad_crc, static_cast<std::int64_t>(fuzz_bytes() / 1000));
  EXPECT_LE(static_cast<double>(fuzz.invented), allowed);
}

TEST(Lms200Fuzz, ThroughASerialPortEveryByteArrivesAsItWasSent) {
  const TemporaryFolder folder;
  serial::PseudoTerminal terminal(folder / "scanner");
  serial::SerialPort port(folder / "scanner", 500000);
  Fuzz fuzz(4, {}), direct(4, {});
  const Bytes stream = fuzz.stream(fuzz_bytes(), [&](Bytes& bytes) { fuzz.damage(bytes); });
  direct.sent = fuzz.sent;
  for (std::span<const std::uint8_t> rest(stream); !rest.empty();) {
    const auto piece = rest.first(std::min<std::size_t>(1 + fuzz.below(2000), rest.size()));
    const auto taken = piece.first(terminal.write(piece));
    ASSERT_FALSE(taken.empty());
    Bytes arrived;
    while (arrived.size() < taken.size()) {
      const auto received = port.read(10'000'000);
      ASSERT_TRUE(received);
      arrived.insert(arrived.end(), received->bytes.begin(), received->bytes.end());
      fuzz.feed(received->bytes);
    }
    ASSERT_EQ(arrived, Bytes(taken.begin(), taken.end()));
    rest = rest.subspan(taken.size());
  }
  fuzz.finish();
  direct.feed_in_pieces(stream);
  fuzz.tell("port", 0.0);
  EXPECT_EQ(fuzz.found, direct.found);
  EXPECT_EQ(fuzz.invented, direct.invented);
  fuzz.expect_all_whole_scans_found();
}

TEST(Lms200Fuzz, NoTelegramIsTooStrangeForItsReader) {
  Fuzz fuzz(5, {});
  const Bytes commands{0x90, 0x91, 0xA0, 0xB0, 0xB1, 0xB2, 0xBA, 0xBB, 0xF4, 0xF7};
  std::int64_t read = 0;
  for (int i = 0; i < 20'000; ++i) {
    Lms200Telegram telegram{0x80, commands[fuzz.below(commands.size())], Bytes(fuzz.below(200))};
    for (std::uint8_t& byte : telegram.data) byte = fuzz.any_byte();
    Lms200ScanFormat format;
    format.measuring_mode = static_cast<int>(fuzz.below(16));
    format.index_bytes = fuzz.below(2) == 0;
    format.partial_scans = fuzz.below(2) == 0;
    format.resolution_cdeg = 25 << fuzz.below(3);
    read += decode_scan(telegram, format).scan.has_value();
    read += decode_status_report(telegram).has_value() + decode_configuration(telegram).has_value();
    read += decode_written(telegram).has_value() + decode_type(telegram).has_value();
    read += decode_errors(telegram).has_value() + decode_mode_changed(telegram).has_value();
    read += decode_variant_accepted(telegram).has_value();
  }
  EXPECT_GT(read, 10'000);
}

TEST(Lms200Fuzz, SimulatedDeviceSurvivesItsHost) {
  Fuzz fuzz(6, {});
  std::int64_t now_us = 0;
  simulation::Lms200Device device({}, now_us, [](std::int64_t, double) { return LaserLine{}; });
  const std::vector<Lms200Telegram> requests{
      {0, 0x10, {}},
      {0, 0x31, {}},
      {0, 0x32, {}},
      {0, 0x3A, {}},
      {0, 0x74, {}},
      {0, 0x20, {0x24}},
      {0, 0x20, {0x2A}},
      {0, 0x20, {0x25}},
      {0, 0x30, {1}},
      {0, 0x20, {0x48}},
      {0, 0x20, {0x42}},
      {0, 0x66, {1}},
      {0, 0x77, Bytes(34, 1)},
      {0, 0x3B, {100, 0, 25, 0}},
      {0, 0x20, {0, 'S', 'I', 'C', 'K', '_', 'L', 'M', 'S'}}};
  std::size_t heard = 0;
  for (int i = 0; i < 5000; ++i) {
    Bytes bytes = encode(requests[fuzz.below(requests.size())]);
    if (fuzz.below(3) == 0) fuzz.damage(bytes);
    device.receive(now_us, fuzz.below(10) == 0 ? 9600 : device.baud(), bytes);
    now_us += static_cast<std::int64_t>(fuzz.below(200'000));
    heard += device.sent_until(now_us, fuzz.below(2) == 0 ? 38400 : 0).size();
  }
  EXPECT_GT(heard, 100'000u);
}

}  // namespace
}  // namespace voxlist::scanner
