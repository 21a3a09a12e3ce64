#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "voxlist/scanner/lms200/lms200_telegram.h"

namespace voxlist::test {

/// "02 00 01" as bytes.
inline std::vector<std::uint8_t> from_hex(const std::string& text) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 3)
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
  return bytes;
}

/// A telegram that is printed in a manual, or was seen on a line, complete with its CRC.
struct Lms200Vector {
  const char* meaning;
  const char* bytes;
};

inline const std::vector<Lms200Vector> kLms200Requests{
    {"status", "02 00 01 00 31 15 12"},
    {"type", "02 00 01 00 3A 1E 12"},
    {"errors", "02 00 01 00 32 16 12"},
    {"configuration", "02 00 01 00 74 50 12"},
    {"reset", "02 00 01 00 10 34 12"},
    {"installation mode", "02 00 0A 00 20 00 53 49 43 4B 5F 4C 4D 53 BE C5"},
    {"9600 baud", "02 00 02 00 20 42 52 08"},
    {"19200 baud", "02 00 02 00 20 41 51 08"},
    {"38400 baud", "02 00 02 00 20 40 50 08"},
    {"500000 baud", "02 00 02 00 20 48 58 08"},
    {"continuous", "02 00 02 00 20 24 34 08"},
    {"stop", "02 00 02 00 20 25 35 08"},
    {"one scan", "02 00 02 00 30 01 31 18"},
    {"mean of 2", "02 00 02 00 36 02 3E 1E"},
    {"partial scans", "02 00 02 00 20 2A 3A 08"},
    {"continuous mean of 4", "02 00 03 00 20 26 04 78 3E"},
    {"sub-range 1..181", "02 00 06 00 20 27 01 00 B5 00 12 09"},
    {"sub-range 1..361", "02 00 06 00 20 27 01 00 69 01 AB D4"},
    {"variant 100/1", "02 00 05 00 3B 64 00 64 00 1D 0F"},
    {"variant 100/0.5", "02 00 05 00 3B 64 00 32 00 B1 59"},
    {"variant 100/0.25", "02 00 05 00 3B 64 00 19 00 E7 72"},
    {"variant 180/1", "02 00 05 00 3B B4 00 64 00 97 49"},
    {"variant 180/0.5", "02 00 05 00 3B B4 00 32 00 3B 1F"},
    {"permanent baud", "02 00 02 00 66 01 9D 4E"},
};

inline const std::vector<Lms200Vector> kLms200Replies{
    {"mode changed", "02 80 03 00 A0 00 10 16 0A"},
    {"mode changed, from 81", "02 81 03 00 A0 00 10 36 1A"},
    {"mode refused", "02 80 03 00 A0 01 10 14 0B"},
    {"reset", "02 80 02 00 91 10 79 30"},
    {"rejected", "02 80 02 00 92 10 7F 33"},
    {"variant 180/1", "02 80 07 00 BB 01 B4 00 64 00 10 5B 30"},
    {"variant 180/0.5", "02 80 07 00 BB 01 B4 00 32 00 10 03 9D"},
    {"variant 100/1", "02 80 07 00 BB 01 64 00 64 00 10 4F BD"},
    {"power on",
     "02 81 17 00 90 4C 4D 53 32 30 30 3B 33 30 31 30 36 33 3B 56 30 32 2E 30 36 20 13 64 5A"},
    {"five values", "02 80 0E 00 B0 05 00 64 00 C8 00 FF 1F FE 1F F7 1F 10 FC EA"},
};

/// Scans of values that count up from 1000: their CRCs are known.
struct Lms200RampVector {
  std::size_t values;
  std::uint8_t unit_bits;  ///< high byte of the count word: 00 cm, 40 mm
  std::size_t bytes;
  std::uint16_t crc;
};

inline const std::vector<Lms200RampVector> kLms200Ramps{
    {181, 0x40, 372, 0xBEB3}, {181, 0x00, 372, 0x2286}, {361, 0x40, 732, 0x0C86}};

inline scanner::Lms200Telegram ramp(std::size_t values, std::uint8_t unit_bits) {
  scanner::Lms200Telegram telegram{0x80, 0xB0, {}};
  const auto put = [&](std::size_t word) {
    telegram.data.push_back(static_cast<std::uint8_t>(word & 0xFF));
    telegram.data.push_back(static_cast<std::uint8_t>(word >> 8));
  };
  put(values | static_cast<std::size_t>(unit_bits) << 8);
  for (std::size_t i = 0; i < values; ++i) put(1000 + i);
  telegram.data.push_back(0x10);
  return telegram;
}

}  // namespace voxlist::test
