#include "voxlist/scanner/lms200/lms200_telegram.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/scanner/lms200/lms200_vectors.h"

namespace voxlist::scanner {
namespace {

using Kind = Lms200Event::Kind;
using test::from_hex;
using test::ramp;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using Bytes = std::vector<std::uint8_t>;

std::vector<Lms200Event> events(Lms200Parser& parser) {
  std::vector<Lms200Event> all;
  while (auto event = parser.next()) all.push_back(std::move(*event));
  return all;
}

std::vector<Lms200Telegram> telegrams(Lms200Parser& parser) {
  std::vector<Lms200Telegram> all;
  for (Lms200Event& event : events(parser))
    if (event.kind == Kind::kTelegram) all.push_back(std::move(event.telegram));
  return all;
}

std::vector<Lms200Telegram> parsed(const Bytes& bytes) {
  Lms200Parser parser;
  parser.feed(0, bytes);
  parser.feed(2 * Lms200Parser::kGap_us, {});
  return telegrams(parser);
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

// What a vector says, read without the parser.
Lms200Telegram contents(const Bytes& bytes) {
  return {bytes[1], bytes[4], {bytes.begin() + 5, bytes.end() - 2}};
}

void expect_vectors(const std::vector<test::Lms200Vector>& vectors,
                    Lms200Parser::Plausible plausible) {
  for (const test::Lms200Vector& vector : vectors) {
    const Bytes bytes = from_hex(vector.bytes);
    EXPECT_EQ(encode(contents(bytes)), bytes) << vector.meaning;
    Lms200Parser parser(plausible);
    parser.feed(0, bytes);
    EXPECT_THAT(telegrams(parser), ElementsAre(contents(bytes))) << vector.meaning;
    EXPECT_EQ(parser.counts().skipped_bytes, 0) << vector.meaning;
  }
}

TEST(Lms200Telegram, RequestsAreThoseOfTheManual) {
  expect_vectors(test::kLms200Requests, plausible_lms200_request);
}

TEST(Lms200Telegram, RepliesAreThoseOfTheManual) {
  expect_vectors(test::kLms200Replies, plausible_lms200_reply);
}

TEST(Lms200Telegram, ScansHaveTheKnownLengthAndChecksum) {
  for (const test::Lms200RampVector& vector : test::kLms200Ramps) {
    const Lms200Telegram telegram = ramp(vector.values, vector.unit_bits);
    const Bytes bytes = encode(telegram);
    ASSERT_EQ(bytes.size(), vector.bytes);
    EXPECT_EQ(bytes[vector.bytes - 2] | bytes[vector.bytes - 1] << 8, vector.crc);
    EXPECT_THAT(parsed(bytes), ElementsAre(telegram));
  }
}

TEST(Lms200Telegram, LongestOneIsEncodedAndALongerOneIsNot) {
  Lms200Telegram telegram{0x80, 0xB0, Bytes(807)};
  EXPECT_THAT(encode(telegram), SizeIs(kMaxLms200TelegramBytes));
  EXPECT_THAT(parsed(encode(telegram)), ElementsAre(telegram));
  telegram.data.push_back(0);
  EXPECT_THROW(encode(telegram), std::invalid_argument);
}

TEST(Lms200Telegram, CommandWithTheChecksumOfAnotherIsRefused) {
  Lms200Parser parser(plausible_lms200_request);
  parser.feed(0, from_hex("02 00 02 00 20 48 50 08"));
  EXPECT_THAT(events(parser), IsEmpty());
  EXPECT_EQ(parser.counts().bad_crc, 1);
}

TEST(Lms200Parser, TellsBytesOutsideOfTelegramsAndTheTelegramBehindThem) {
  Lms200Parser parser;
  parser.feed(7, joined({{0x15}, {0x06}, encode(ramp(5, 0x00))}));
  const auto all = events(parser);
  ASSERT_THAT(all, SizeIs(3));
  EXPECT_EQ(all[0].kind, Kind::kRefused);
  EXPECT_EQ(all[1].kind, Kind::kAccepted);
  EXPECT_EQ(all[2].kind, Kind::kTelegram);
}

TEST(Lms200Parser, ControlBytesInsideOfDataAreData) {
  const Lms200Telegram telegram{0x80, 0xB0, {2, 0, 0x02, 0x06, 0x15, 0x02, 0x02}};
  const Lms200Telegram looks_like_a_start{
      0x80, 0xB0, joined({{5, 0}, from_hex("02 80 03 00 A0 00 10 16 0A 15"), {0x10}})};
  Lms200Parser parser;
  parser.feed(0, joined({encode(telegram), encode(looks_like_a_start)}));
  const auto all = events(parser);
  ASSERT_THAT(all, SizeIs(2));
  EXPECT_EQ(all[0].telegram, telegram);
  EXPECT_EQ(all[1].telegram, looks_like_a_start);
}

TEST(Lms200Parser, TelegramThatLostItsStartGivesNoEvents) {
  Lms200Telegram telegram = ramp(181, 0x40);
  for (std::size_t i = 10; i < 300; i += 7) telegram.data[i] = i % 2 == 0 ? 0x06 : 0x15;
  Bytes bytes = encode(telegram);
  bytes.erase(bytes.begin());
  Lms200Parser parser;
  parser.feed(0, joined({bytes, encode(ramp(181, 0x40))}));
  EXPECT_THAT(events(parser), SizeIs(1));
  EXPECT_EQ(parser.counts().skipped_bytes, 371);
}

TEST(Lms200Parser, FindsTwoTelegramsInOneRead) {
  EXPECT_THAT(parsed(joined({encode(ramp(181, 0x40)), encode(ramp(361, 0x40))})),
              ElementsAre(ramp(181, 0x40), ramp(361, 0x40)));
}

TEST(Lms200Parser, FindsATelegramOverManyReads) {
  const Bytes bytes = encode(ramp(181, 0x40));
  for (const std::size_t piece : {1u, 2u, 5u, 64u}) {
    Lms200Parser parser;
    for (std::size_t i = 0; i < bytes.size(); i += piece)
      parser.feed(0, std::span(bytes).subspan(i, std::min(piece, bytes.size() - i)));
    EXPECT_THAT(telegrams(parser), ElementsAre(ramp(181, 0x40))) << piece;
  }
}

TEST(Lms200Parser, EventHasTheTimeOfThePieceOfItsFirstByte) {
  const Bytes scan = encode(ramp(5, 0x40));
  Lms200Parser parser;
  parser.feed(1000, std::span(scan).first(3));
  parser.feed(2000, std::span(scan).subspan(3, 9));
  parser.feed(3000, joined({{scan.begin() + 12, scan.end()}, {0x06}, {scan.begin(), scan.end()}}));
  parser.feed(4000, std::span(scan).first(1));
  parser.feed(5000, std::span(scan).subspan(1));
  std::vector<std::int64_t> times;
  for (const Lms200Event& event : events(parser)) times.push_back(event.utime_us);
  EXPECT_THAT(times, ElementsAre(1000, 3000, 3000, 4000));
}

TEST(Lms200Parser, FindsTheTelegramInsideOfADamagedOne) {
  const Bytes whole = encode(ramp(5, 0x40));
  Bytes damaged = encode(ramp(181, 0x40));
  damaged.resize(100);  // torn: its length swallows what comes next
  EXPECT_THAT(parsed(joined({damaged, whole, whole, whole})), SizeIs(3));
  damaged = encode(ramp(181, 0x40));
  std::copy(whole.begin(), whole.end(), damaged.begin() + 50);
  EXPECT_THAT(parsed(damaged), ElementsAre(ramp(5, 0x40)));
}

TEST(Lms200Parser, ALostByteCostsOneTelegram) {
  const Bytes whole = encode(ramp(181, 0x40));
  for (std::size_t lost = 0; lost < whole.size(); ++lost) {
    Bytes damaged = whole;
    damaged.erase(damaged.begin() + static_cast<std::ptrdiff_t>(lost));
    EXPECT_THAT(parsed(joined({whole, damaged, whole})), SizeIs(2)) << lost;
  }
}

TEST(Lms200Parser, NoSingleDamagedBitIsAccepted) {
  const Bytes whole = encode(ramp(5, 0x40));
  for (std::size_t bit = 0; bit < whole.size() * 8; ++bit) {
    Bytes damaged = whole;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ 1u << bit % 8);
    EXPECT_THAT(parsed(damaged), IsEmpty()) << bit;
  }
}

TEST(Lms200Parser, GivesUpATornTelegramAfterAGap) {
  const Bytes scan = encode(ramp(181, 0x40));
  Lms200Parser parser;
  parser.feed(0, std::span(scan).first(200));
  parser.feed(Lms200Parser::kGap_us, {});
  EXPECT_EQ(parser.counts().torn, 0);
  parser.feed(Lms200Parser::kGap_us + 1, from_hex("06 02 80 03 00 A0 00 10 16 0A"));
  EXPECT_THAT(events(parser), SizeIs(2));
  EXPECT_EQ(parser.counts().torn, 1);
  EXPECT_EQ(parser.counts().skipped_bytes, 200);
}

TEST(Lms200Parser, SilenceAloneUncoversATelegramBehindATornOne) {
  Bytes bytes = joined({encode(ramp(181, 0x40)), encode(ramp(5, 0x40))});
  bytes.erase(bytes.begin() + 100, bytes.begin() + 250);
  Lms200Parser parser;
  parser.feed(50, bytes);
  EXPECT_THAT(events(parser), IsEmpty());
  parser.feed(50 + Lms200Parser::kGap_us + 1, {});
  const auto all = events(parser);
  ASSERT_THAT(all, SizeIs(1));
  EXPECT_EQ(all[0].telegram, ramp(5, 0x40));
  EXPECT_EQ(all[0].utime_us, 50);
}

TEST(Lms200Parser, AClockSetBackTearsNothing) {
  const Bytes scan = encode(ramp(181, 0x40));
  Lms200Parser parser;
  parser.feed(1'000'000'000, std::span(scan).first(200));
  parser.feed(0, std::span(scan).subspan(200));
  EXPECT_THAT(events(parser), SizeIs(1));
}

TEST(Lms200Parser, ClearForgetsWhatWasUnderWay) {
  const Bytes scan = encode(ramp(181, 0x40));
  Lms200Parser parser;
  parser.feed(0, scan);
  parser.feed(0, std::span(scan).first(200));
  parser.clear();
  parser.feed(10, joined({{0x06}, scan}));
  const auto all = events(parser);
  ASSERT_THAT(all, SizeIs(2));
  EXPECT_EQ(all[0].kind, Kind::kAccepted);
  EXPECT_EQ(all[1].utime_us, 10);
}

TEST(Lms200Parser, RepliesAndRequestsAreNotMistakenForEachOther) {
  EXPECT_THAT(parsed(from_hex("02 00 01 00 31 15 12")), IsEmpty());
  EXPECT_THAT(parsed(encode({0x80, 0x31, {}})), IsEmpty());
  EXPECT_THAT(parsed(encode({0x00, 0xA0, {0, 0x10}})), IsEmpty());
  EXPECT_THAT(parsed(encode({0x82, 0xA0, {0, 0x10}})), IsEmpty());
}

TEST(Lms200Parser, LengthsThatACommandCannotHaveAreRefused) {
  const auto lengths = [](std::uint8_t command) {
    std::vector<std::size_t> accepted;
    for (std::size_t n = 0; n <= 808; ++n)
      if (plausible_lms200_reply(command, n)) accepted.push_back(n);
    return accepted;
  };
  EXPECT_THAT(lengths(0xA0), ElementsAre(2));
  EXPECT_THAT(lengths(0x91), ElementsAre(1));
  EXPECT_THAT(lengths(0x92), ElementsAre(1));
  EXPECT_THAT(lengths(0xBB), ElementsAre(6));
  EXPECT_EQ(lengths(0xB0).front(), 5u);
  EXPECT_EQ(lengths(0xB0).back(), 807u);
  EXPECT_THAT(lengths(0xB0), SizeIs(402));  // even ones hold half a value
  EXPECT_THAT(lengths(0x31), IsEmpty());
  EXPECT_TRUE(plausible_lms200_reply(0xB1, 153) && plausible_lms200_reply(0xB1, 147));
  EXPECT_TRUE(plausible_lms200_reply(0xF4, 33) && plausible_lms200_reply(0xF4, 35));
  EXPECT_TRUE(plausible_lms200_reply(0xF7, 34) && plausible_lms200_reply(0xF7, 36));
}

// Not a measure of speed: with quadratic rescans this would not end within the test's time.
TEST(Lms200Parser, WorstCaseOfNestedStartsStaysLinear) {
  const Bytes start = from_hex("02 80 28 03 B0");
  Bytes bytes;
  while (bytes.size() < 1'000'000) bytes.insert(bytes.end(), start.begin(), start.end());
  EXPECT_THAT(parsed(bytes), IsEmpty());
}

TEST(Lms200Parser, AnyCutIntoPiecesGivesTheSameEvents) {
  std::mt19937 random(1);
  Bytes bytes;
  for (int i = 0; i < 50; ++i) {
    const Bytes scan = encode(ramp(5 + random() % 100, 0x40));
    bytes.insert(bytes.end(), scan.begin(), scan.end());
    if (i % 3 == 0) bytes.resize(bytes.size() - random() % 60);
    if (i % 5 == 0) bytes.push_back(0x06);
  }
  Lms200Parser whole, pieces;
  whole.feed(0, bytes);
  for (std::size_t i = 0; i < bytes.size();) {
    const std::size_t n = std::min<std::size_t>(1 + random() % 200, bytes.size() - i);
    pieces.feed(0, std::span(bytes).subspan(i, n));
    i += n;
  }
  const auto expected = telegrams(whole);
  EXPECT_THAT(expected, SizeIs(testing::Gt(20u)));
  EXPECT_EQ(telegrams(pieces), expected);
}

}  // namespace
}  // namespace voxlist::scanner
