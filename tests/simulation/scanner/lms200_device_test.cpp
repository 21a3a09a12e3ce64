#include "voxlist/simulation/scanner/lms200_device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/scanner/lms200/lms200_vectors.h"
#include "voxlist/scanner/lms200/lms200_commands.h"
#include "voxlist/scanner/lms200/lms200_reports.h"

namespace voxlist::simulation {
namespace {

using Kind = scanner::Lms200Event::Kind;
using test::from_hex;
using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using Bytes = std::vector<std::uint8_t>;

constexpr std::int64_t kStart = 1'700'000'000'000'000;
constexpr std::int64_t kSecond = 1'000'000;

// The range of a beam says when it left and at what angle: 1 m + 1 mm a quarter of a degree.
LaserLine angles_as_ranges(std::int64_t utime_us, double first_angle_rad) {
  LaserLine line;
  line.utime_us = utime_us;
  line.first_angle_rad = first_angle_rad;
  for (std::size_t i = 0; i < 181; ++i)
    line.ranges_m.push_back(static_cast<float>(1.0 + line.angle_rad(i) * 180.0 / M_PI * 0.004));
  return line;
}

/// A host that speaks to the device and hears everything.
struct Host {
  explicit Host(const Lms200Device::Config& config = {}, MeasureLine measure = angles_as_ranges)
      : device(config, kStart, std::move(measure)), baud(config.baud) {
    if (!config.streams_at_start) wait(kSecond);
  }

  std::vector<scanner::Lms200Event> wait(std::int64_t duration_us) {
    now_us += duration_us;
    for (const auto& [utime_us, byte] : device.sent_until(now_us, baud)) {
      EXPECT_GE(utime_us, last_byte_us);
      last_byte_us = utime_us;
      parser.feed(utime_us, Bytes{byte});
    }
    parser.feed(now_us, {});
    std::vector<scanner::Lms200Event> events;
    while (auto event = parser.next()) events.push_back(std::move(*event));
    return events;
  }

  void say(const std::string& hex) { device.receive(now_us, baud, from_hex(hex)); }

  // 06 and a telegram, else a telegram with command 0.
  scanner::Lms200Telegram ask(const std::string& hex) {
    say(hex);
    const auto events = wait(kSecond);
    if (events.size() != 2 || events[0].kind != Kind::kAccepted) return {};
    return events[1].telegram;
  }

  void ask_for_bytes(const Bytes& bytes) { device.receive(now_us, baud, bytes); }

  Bytes configuration() {
    return scanner::decode_configuration(ask("02 00 01 00 74 50 12"))->bytes;
  }

  scanner::Lms200Telegram write(const Bytes& configuration) {
    ask_for_bytes(encode(scanner::Lms200Telegram{0, 0x77, configuration}));
    const auto events = wait(kSecond);
    return events.size() == 2 ? events[1].telegram : scanner::Lms200Telegram{};
  }

  void configure(std::size_t at, std::uint8_t value) {
    Bytes bytes = configuration();
    bytes[at] = value;
    ask("02 00 0A 00 20 00 53 49 43 4B 5F 4C 4D 53 BE C5");
    EXPECT_TRUE(scanner::decode_written(write(bytes))->accepted);
    ask(kStop);
  }

  void go_fast() {
    EXPECT_EQ(ask("02 00 02 00 20 48 58 08"), kModeChanged);
    baud = 500000;
  }

  static constexpr const char* kStop = "02 00 02 00 20 25 35 08";
  static constexpr const char* kContinuous = "02 00 02 00 20 24 34 08";
  static constexpr const char* kPartial = "02 00 02 00 20 2A 3A 08";
  static constexpr const char* kStatus = "02 00 01 00 31 15 12";
  static constexpr const char* kVariant180By1 = "02 00 05 00 3B B4 00 64 00 97 49";
  static constexpr const char* kVariant100By025 = "02 00 05 00 3B 64 00 19 00 E7 72";
  const scanner::Lms200Telegram kModeChanged{0x80, 0xA0, {0x00, 0x10}};

  Lms200Device device;
  scanner::Lms200Parser parser;
  int baud;
  std::int64_t now_us = kStart;
  std::int64_t last_byte_us = 0;
};

std::vector<scanner::Lms200Event> scans(std::vector<scanner::Lms200Event> events) {
  std::erase_if(events, [](const scanner::Lms200Event& e) {
    return e.kind != Kind::kTelegram || e.telegram.command != scanner::lms200::kScan;
  });
  return events;
}

TEST(Lms200Device, SaysItsTypeAtPowerOnAndHearsNothingBefore) {
  Lms200Device device({}, kStart, angles_as_ranges);
  device.receive(kStart + 100'000, 9600, from_hex(Host::kStatus));
  EXPECT_THAT(device.sent_until(kStart + 500'000), IsEmpty());
  EXPECT_EQ(device.next_byte_utime_us(), kStart + 501'042);
  Bytes bytes;
  for (const auto& timed : device.sent_until(kStart + kSecond)) bytes.push_back(timed.byte);
  Bytes expected = from_hex(test::kLms200Replies[8].bytes);
  EXPECT_THAT(bytes, SizeIs(expected.size()));
  EXPECT_EQ(Bytes(bytes.begin() + 4, bytes.end() - 2),
            Bytes(expected.begin() + 4, expected.end() - 2));
}

TEST(Lms200Device, BytesTakeTheirTimeOnTheLine) {
  Host host;
  host.say(Host::kStatus);
  std::vector<std::int64_t> times;
  for (const auto& timed : host.device.sent_until(host.now_us + kSecond))
    times.push_back(timed.utime_us);
  ASSERT_THAT(times, SizeIs(161));
  EXPECT_NEAR(static_cast<double>(times[160] - times[0]), 160 * 1e7 / 9600, 1.0);
}

TEST(Lms200Device, AnswersWhatADriverAsks) {
  Host host;
  const auto report = scanner::decode_status_report(host.ask(Host::kStatus));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->firmware, "V02.06");
  EXPECT_EQ(report->mode, scanner::lms200::kOnRequest);
  EXPECT_EQ(report->angle_deg, 180);
  EXPECT_EQ(report->resolution_cdeg, 50);
  EXPECT_EQ(report->baud, 9600);
  EXPECT_EQ(report->units, 0);
  EXPECT_EQ(scanner::decode_type(host.ask("02 00 01 00 3A 1E 12")), "LMS200;301063;V02.06");
  EXPECT_TRUE(scanner::decode_errors(host.ask("02 00 01 00 32 16 12"))->empty());
  EXPECT_EQ(encode(host.ask(Host::kVariant180By1)),
            from_hex("02 80 07 00 BB 01 B4 00 64 00 10 5B 30"));
  EXPECT_EQ(encode(host.ask(Host::kStop)), from_hex("02 80 03 00 A0 00 10 16 0A"));
  EXPECT_EQ(host.ask("02 00 02 00 36 02 3E 1E").command, scanner::lms200::kRejected);
}

TEST(Lms200Device, RefusesADamagedRequest) {
  Host host;
  host.say("02 00 02 00 20 48 50 08");
  const auto events = host.wait(kSecond);
  ASSERT_THAT(events, SizeIs(1));
  EXPECT_EQ(events[0].kind, Kind::kRefused);
  EXPECT_EQ(host.device.baud(), 9600);
}

TEST(Lms200Device, RefusesAVariantThatItDoesNotHave) {
  Host host;
  host.ask_for_bytes(
      encode(scanner::Lms200Telegram{0, scanner::lms200::kSetVariant, {180, 0, 25, 0}}));
  const auto events = host.wait(kSecond);
  ASSERT_THAT(events, SizeIs(2));
  EXPECT_EQ(events[1].telegram.data, (Bytes{0, 180, 0, 50, 0, 0x10}));
}

TEST(Lms200Device, WritesItsConfigurationInInstallationModeOnly) {
  Host host;
  Bytes bytes = host.configuration();
  ASSERT_THAT(bytes, SizeIs(34));
  bytes[6] = 1;
  EXPECT_EQ(host.write(bytes).command, scanner::lms200::kRejected);
  EXPECT_EQ(host.configuration()[6], 0);
  EXPECT_EQ(host.ask("02 00 0A 00 20 00 53 49 43 4B 5F 4C 4D 53 BE C5"), host.kModeChanged);
  const auto written = scanner::decode_written(host.write(bytes));
  ASSERT_TRUE(written && written->accepted);
  EXPECT_EQ(written->configuration.bytes, bytes);
  EXPECT_EQ(host.device.configuration_writes(), 1);
  bytes[5] = 0x0D;  // reserved
  EXPECT_FALSE(scanner::decode_written(host.write(bytes))->accepted);
  bytes.resize(32);
  EXPECT_EQ(host.write(bytes).command, scanner::lms200::kRejected);
  host.device.power_cycle(host.now_us);
  host.wait(kSecond);
  EXPECT_EQ(host.configuration()[6], 1);
  EXPECT_EQ(host.device.configuration_writes(), 1);
}

TEST(Lms200Device, WantsThePassword) {
  Host host;
  host.ask_for_bytes(
      encode(scanner::Lms200Telegram{0, 0x20, {0, 'S', 'I', 'C', 'K', '_', 'P', 'L', 'S'}}));
  EXPECT_EQ(host.wait(kSecond)[1].telegram.data[0], 1);
  EXPECT_EQ(scanner::decode_status_report(host.ask(Host::kStatus))->mode,
            scanner::lms200::kOnRequest);
}

TEST(Lms200Device, OldFirmwareHasAShortConfiguration) {
  Lms200Device::Config config;
  config.long_configuration = false;
  Host host(config);
  EXPECT_THAT(host.configuration(), SizeIs(32));
}

TEST(Lms200Device, ChangesItsSpeedBehindTheAnswer) {
  Host host;
  host.go_fast();
  EXPECT_EQ(scanner::decode_status_report(host.ask(Host::kStatus))->baud, 500000);
  host.ask("02 00 02 00 20 42 52 08");
  host.baud = 9600;
  EXPECT_EQ(scanner::decode_status_report(host.ask(Host::kStatus))->baud, 9600);
}

TEST(Lms200Device, AtTheWrongSpeedBothSidesHearGarbage) {
  Host host;
  host.go_fast();
  host.baud = 9600;
  for (int i = 0; i < 20; ++i) {
    host.say(Host::kStatus);
    EXPECT_THAT(host.wait(kSecond), IsEmpty());
  }
  host.baud = 500000;
  host.ask(Host::kVariant180By1);
  host.ask(Host::kContinuous);
  host.baud = 38400;
  EXPECT_THAT(scans(host.wait(10 * kSecond)), IsEmpty());
  EXPECT_GT(host.parser.counts().skipped_bytes, 10'000);
}

TEST(Lms200Device, StreamsOneScanATurnWithTheTimesOfItsMirror) {
  std::vector<std::int64_t> first_beams;
  Host host({}, [&](std::int64_t utime_us, double first_angle_rad) {
    first_beams.push_back(utime_us);
    return angles_as_ranges(utime_us, first_angle_rad);
  });
  host.go_fast();
  host.configure(scanner::Lms200Configuration::kUnits, 1);
  host.ask(Host::kVariant180By1);
  host.say(Host::kContinuous);
  const auto events = scans(host.wait(10 * kSecond));
  ASSERT_NEAR(static_cast<double>(events.size()), 747.0, 2.0);  // the mode's change takes 31 ms
  ASSERT_THAT(first_beams.size() - events.size(), testing::AnyOf(0u, 1u));
  const double half_turn_us = 0.5e6 / 75.03;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const auto result = scanner::decode_scan(events[i].telegram, scanner::Lms200ScanFormat{});
    ASSERT_TRUE(result.scan) << result.refused;
    EXPECT_NEAR(result.scan->values[90].range_m, 1.36, 1e-9);
    EXPECT_NEAR(static_cast<double>(events[i].utime_us - first_beams[i]), half_turn_us + 20.0, 2.0);
  }
  EXPECT_EQ(host.ask(Host::kStop).command, 0);  // scans were still on the line
  EXPECT_THAT(host.wait(kSecond), IsEmpty());
}

TEST(Lms200Device, SkipsScansThatASlowLineCannotCarry) {
  Host host;
  host.ask("02 00 02 00 20 40 50 08");
  host.baud = 38400;
  host.ask(Host::kVariant180By1);
  host.say(Host::kContinuous);
  host.wait(kSecond);
  EXPECT_NEAR(static_cast<double>(host.wait(10 * kSecond).size()), 93.8, 1.5);
}

TEST(Lms200Device, WholeScansOfFineStepsTakeSeveralTurns) {
  Host host;
  host.go_fast();
  host.configure(scanner::Lms200Configuration::kUnits, 1);
  scanner::Lms200ScanFormat format;
  for (const auto& [angle_deg, resolution_cdeg] : {std::pair{180, 50}, {100, 25}, {100, 50}}) {
    host.ask_for_bytes(encode(scanner::Lms200Telegram{
        0,
        scanner::lms200::kSetVariant,
        {static_cast<std::uint8_t>(angle_deg), 0, static_cast<std::uint8_t>(resolution_cdeg), 0}}));
    host.wait(kSecond);
    host.say(Host::kContinuous);
    host.wait(kSecond);
    const auto events = host.wait(10 * kSecond);
    EXPECT_NEAR(static_cast<double>(events.size()), 750.3 * resolution_cdeg / 100, 1.1);
    format.angle_deg = angle_deg;
    format.resolution_cdeg = resolution_cdeg;
    const auto result = scanner::decode_scan(events[1].telegram, format);
    ASSERT_TRUE(result.scan) << result.refused;
    const LaserLine line = scanner::to_laser_line(*result.scan, format, 0);
    for (std::size_t i = 0; i < line.ranges_m.size(); ++i)
      ASSERT_NEAR(line.ranges_m[i], 1.0 + line.angle_rad(i) * 180.0 / M_PI * 0.004, 1e-6) << i;
    host.say(Host::kStop);
    host.wait(kSecond);
  }
}

TEST(Lms200Device, PartialScansComeEachTurnWithTheirNumberAndTheirAngles) {
  Host host;
  host.go_fast();
  host.configure(scanner::Lms200Configuration::kUnits, 1);
  host.configure(scanner::Lms200Configuration::kAvailability,
                 scanner::Lms200Configuration::kIndexBytes);
  host.ask(Host::kVariant100By025);
  host.say(Host::kPartial);
  host.wait(kSecond);
  scanner::Lms200ScanFormat format;
  format.resolution_cdeg = 25;
  format.partial_scans = true;
  format.index_bytes = true;
  const auto events = host.wait(kSecond);
  ASSERT_THAT(events, SizeIs(testing::Ge(74u)));
  std::optional<scanner::Lms200Scan> before;
  for (std::size_t i = 1; i < events.size(); ++i) {
    const auto result = scanner::decode_scan(events[i].telegram, format);
    ASSERT_TRUE(result.scan) << result.refused;
    const LaserLine line = scanner::to_laser_line(*result.scan, format, 0);
    for (const std::size_t beam : {0u, 179u})
      EXPECT_NEAR(line.ranges_m[beam], 1.0 + line.angle_rad(beam) * 180.0 / M_PI * 0.004, 1e-6);
    if (before) {
      EXPECT_EQ(result.scan->partial, (before->partial + 1) % 4);
      EXPECT_EQ(result.scan->scan_index, static_cast<std::uint8_t>(before->scan_index + 1));
      EXPECT_EQ(result.scan->telegram_index, static_cast<std::uint8_t>(before->telegram_index + 1));
    }
    before = result.scan;
  }
}

TEST(Lms200Device, GivesOneScanOnRequest) {
  Host host;
  host.ask(Host::kVariant180By1);
  EXPECT_EQ(host.ask("02 00 02 00 30 01 31 18").command, scanner::lms200::kScan);
  EXPECT_THAT(host.wait(kSecond), IsEmpty());
  host.say(Host::kContinuous);
  host.wait(kSecond);
  host.say("02 00 02 00 30 01 31 18");
  const auto events = host.wait(2 * kSecond);
  EXPECT_TRUE(std::any_of(events.begin(), events.end(), [](const scanner::Lms200Event& event) {
    return event.telegram.command == scanner::lms200::kRejected;
  }));
}

TEST(Lms200Device, LeftStreamingByACrashItCanBeStopped) {
  Lms200Device::Config config;
  config.baud = 500000;
  config.streams_at_start = true;
  Host host(config);
  EXPECT_THAT(scans(host.wait(kSecond)), SizeIs(testing::Ge(73u)));
  host.say(Host::kStop);
  host.wait(100'000);
  EXPECT_EQ(scanner::decode_status_report(host.ask(Host::kStatus))->mode,
            scanner::lms200::kOnRequest);
}

TEST(Lms200Device, AVariantStopsTheStream) {
  Host host;
  host.go_fast();
  host.say(Host::kContinuous);
  host.wait(kSecond);
  host.say(Host::kVariant180By1);
  host.wait(kSecond);
  EXPECT_THAT(host.wait(kSecond), IsEmpty());
}

TEST(Lms200Device, ResetAnswersAndStartsAgainAtTheSpeedOfPowerOn) {
  Host host;
  host.go_fast();
  host.ask(Host::kVariant180By1);
  host.say("02 00 01 00 10 34 12");
  const auto events = host.wait(100'000);
  ASSERT_THAT(events, SizeIs(2));
  EXPECT_EQ(encode(events[1].telegram), from_hex("02 80 02 00 91 10 79 30"));
  host.baud = 9600;
  const auto later = host.wait(kSecond);
  ASSERT_THAT(later, SizeIs(1));
  EXPECT_EQ(later[0].telegram.command, scanner::lms200::kPoweredOn);
  EXPECT_EQ(scanner::decode_status_report(host.ask(Host::kStatus))->resolution_cdeg, 50);
}

TEST(Lms200Device, SwitchedOffInTheMiddleOfATelegramItStops) {
  Host host;
  host.say(Host::kStatus);
  host.device.power_cycle(host.now_us + 50'000);
  const auto bytes = host.device.sent_until(host.now_us + 400'000);
  EXPECT_THAT(bytes, SizeIs(testing::AllOf(testing::Gt(20u), testing::Lt(60u))));
  EXPECT_LE(bytes.back().utime_us, host.now_us + 50'000);
}

TEST(Lms200Device, NextByteIsKnownWhileItStreams) {
  Host host;
  host.go_fast();
  host.ask(Host::kVariant180By1);
  EXPECT_EQ(host.device.next_byte_utime_us(), std::nullopt);
  host.say(Host::kContinuous);
  for (int i = 0; i < 2000; ++i) {
    const auto next = host.device.next_byte_utime_us();
    ASSERT_TRUE(next);
    ASSERT_THAT(host.device.sent_until(*next - 1), IsEmpty());
    ASSERT_THAT(host.device.sent_until(*next), SizeIs(1));
  }
}

// One fault, on a device that streams whole scans in millimetres.
struct Faulty : Host {
  explicit Faulty(const Lms200Faults& faults) {
    go_fast();
    configure(scanner::Lms200Configuration::kUnits, 1);
    ask(kVariant180By1);
    say(kContinuous);
    wait(kSecond);
    device.set_faults(faults);
    wait(20'000);
    start = parser.counts();
    events = wait(10 * kSecond);
  }

  std::vector<std::string> refusals() const {
    std::vector<std::string> all;
    for (const scanner::Lms200Event& event : events)
      if (const char* refused = scanner::decode_scan(event.telegram, {}).refused)
        all.push_back(refused);
    return all;
  }

  // The share of beams of a kind.
  double share(scanner::Lms200Value::Kind kind) const {
    std::size_t beams = 0, all = 0;
    for (const scanner::Lms200Event& event : events) {
      const auto result = scanner::decode_scan(event.telegram, {});
      for (const scanner::Lms200Value& value : result.scan->values) beams += value.kind == kind;
      all += result.scan->values.size();
    }
    return static_cast<double>(beams) / static_cast<double>(all);
  }

  std::vector<scanner::Lms200Event> events;
  scanner::Lms200Parser::Counts start;
};

TEST(Lms200Device, LosesDamagesAndInventsBytes) {
  for (double Lms200Faults::*const member :
       {&Lms200Faults::drop_byte, &Lms200Faults::corrupt_byte, &Lms200Faults::noise_byte}) {
    Lms200Faults faults;
    faults.*member = 1e-3;
    const Faulty host(faults);
    // exp(-0.372) of 750 scans are whole.
    EXPECT_NEAR(static_cast<double>(host.events.size()), 517.0, 60.0);
    EXPECT_GT(host.parser.counts().bad_crc, host.start.bad_crc + 50);
  }
}

TEST(Lms200Device, ScansCanSayTheWrongUnitOrBePartial) {
  Lms200Faults faults;
  faults.wrong_unit = true;
  EXPECT_THAT(Faulty(faults).refusals(),
              testing::AllOf(SizeIs(testing::Gt(700u)), Each("wrong_unit")));
  faults = {};
  faults.partial_bits = true;
  EXPECT_THAT(Faulty(faults).refusals(),
              testing::AllOf(SizeIs(testing::Gt(700u)), Each("wrong_partial")));
}

TEST(Lms200Device, SilentDeviceSaysNothingAndComesBack) {
  Lms200Faults faults;
  faults.silent = true;
  Faulty host(faults);
  EXPECT_THAT(host.events, IsEmpty());
  host.device.set_faults({});
  EXPECT_NEAR(static_cast<double>(host.wait(kSecond).size()), 75.0, 1.0);
}

TEST(Lms200Device, RefusesEverythingIfToldSo) {
  Host host;
  Lms200Faults faults;
  faults.refuse = true;
  host.device.set_faults(faults);
  host.say(Host::kStatus);
  const auto events = host.wait(kSecond);
  ASSERT_THAT(events, SizeIs(1));
  EXPECT_EQ(events[0].kind, Kind::kRefused);
}

TEST(Lms200Device, AnswersFromAddress81AndWithPollution) {
  Lms200Faults faults;
  faults.address_81 = true;
  faults.pollution = true;
  const Faulty host(faults);
  ASSERT_THAT(host.events, SizeIs(testing::Gt(700u)));
  for (const scanner::Lms200Event& event : host.events) {
    EXPECT_EQ(event.telegram.address, 0x81);
    EXPECT_TRUE(scanner::decode_scan(event.telegram, {}).scan->status.polluted);
  }
}

TEST(Lms200Device, DazzlesBeamsByCodeAndByBit) {
  Lms200Faults faults;
  faults.dazzle = 0.1;
  const Faulty host(faults);
  std::size_t by_bit = 0;
  for (const scanner::Lms200Event& event : host.events)
    for (std::size_t i = 3; i < event.telegram.data.size() - 1; i += 2)
      by_bit += event.telegram.data[i] >> 7;
  EXPECT_NEAR(host.share(scanner::Lms200Value::Kind::kDazzled), 0.1, 0.01);
  EXPECT_NEAR(static_cast<double>(by_bit), 0.05 * 181 * 750, 500.0);
}

TEST(Lms200Device, SendsBeamsBeyondMaximum) {
  Lms200Faults faults;
  faults.over_max = 0.1;
  EXPECT_NEAR(Faulty(faults).share(scanner::Lms200Value::Kind::kOverMaximum), 0.1, 0.01);
}

TEST(Lms200Device, EqualSeedsGiveEqualBytes) {
  Lms200Faults faults;
  faults.noise_byte = 1e-3;
  faults.dazzle = 0.01;
  const Faulty a(faults), b(faults);
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t i = 0; i < a.events.size(); ++i)
    EXPECT_EQ(a.events[i].telegram, b.events[i].telegram);
}

}  // namespace
}  // namespace voxlist::simulation
