#include "voxlist/serial/edge_source.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <random>

#include "tests/temporary_folder.h"
#include "voxlist/serial/device_time.h"
#include "voxlist/serial/edge_text.h"
#include "voxlist/serial/modem_edge_source.h"
#include "voxlist/serial/port.h"
#include "voxlist/serial/pseudo_terminal.h"
#include "voxlist/serial/reopened_edge_source.h"
#include "voxlist/serial/text_edge_source.h"

namespace voxlist::serial {
namespace {

using test::TemporaryFolder;

constexpr std::int64_t kWall_us = 1'700'000'000'000'000;

std::vector<std::uint8_t> bytes(const std::string& text) { return {text.begin(), text.end()}; }

// ---- a device's clock

TEST(DeviceTime, FindsTheTimeUnderArrivalsThatAreLate) {
  DeviceTime time;
  std::mt19937 random(3);
  std::exponential_distribution<double> late_us(1.0 / 2000.0);
  double worst_us = 0.0;
  for (int i = 0; i < 12'000; ++i) {  // a minute; the device's clock is 0.3 % slow, and wraps
    const double true_us = i * 5000.0;
    const auto device_us =
        static_cast<std::uint32_t>(4'290'000'000LL + std::llround(true_us * 0.997));
    const auto arrival_us = kWall_us + std::llround(true_us + 300.0 + late_us(random));
    const auto wall_us = time.wall_us(device_us, arrival_us);
    ASSERT_TRUE(wall_us);
    const double off_us = static_cast<double>(*wall_us - kWall_us) - true_us - 300.0;
    if (i > 2000) worst_us = std::max(worst_us, std::abs(off_us));
  }
  std::printf("device's time under arrivals 2 ms late in the mean: worst error %.0f us\n",
              worst_us);
  EXPECT_LT(worst_us, 200.0);
}

TEST(DeviceTime, LeavesOutATornNumberAndStartsAnewWhenAClockWasSet) {
  DeviceTime time;
  for (std::uint32_t i = 1; i < 100; ++i)
    ASSERT_EQ(time.wall_us(5000 * i, kWall_us + 5000 * i), kWall_us + 5000 * i);
  EXPECT_FALSE(time.wall_us(77, kWall_us + 5000 * 100));
  EXPECT_EQ(time.wall_us(5000 * 101, kWall_us + 5000 * 101), kWall_us + 5000 * 101);
  int lost = 0;
  for (std::uint32_t i = 1; i < 100; ++i) {  // the microcontroller was reset
    const auto wall_us = time.wall_us(5000 * i, kWall_us + 600'000 + 5000 * i);
    lost += !wall_us;
    EXPECT_EQ(wall_us.value_or(kWall_us + 600'000 + 5000 * i), kWall_us + 600'000 + 5000 * i);
  }
  EXPECT_EQ(lost, 4);
}

// ---- text

TEST(EdgeText, ReadsLinesInAnyPieces) {
  EdgeText text;
  EXPECT_TRUE(text.feed(kWall_us, bytes("34\n")).empty()) << "may have lost its beginning";
  EXPECT_TRUE(text.feed(kWall_us, bytes("10")).empty());
  EXPECT_EQ(text.feed(kWall_us + 1000, bytes("00\n")), std::vector<std::int64_t>{kWall_us + 1000});
  EXPECT_EQ(text.feed(kWall_us + 3000, bytes("2000\r\n3000\n")),
            (std::vector<std::int64_t>{kWall_us + 2000, kWall_us + 3000}));
  EXPECT_EQ(text.garbage(), 0);
}

TEST(EdgeText, CountsGarbageAndSkipsIt) {
  EdgeText text;
  text.feed(kWall_us, bytes("\n1000\n"));
  const std::string garbage = "x\n\n-5\n12 34\n\x80\xff\n" + std::string(100'000, '7') + "\n";
  EXPECT_TRUE(text.feed(kWall_us + 500, bytes(garbage)).empty());
  EXPECT_EQ(text.garbage(), 6);
  EXPECT_EQ(text.feed(kWall_us + 1000, bytes("2000\n")).size(), 1u);
}

TEST(EdgeText, SurvivesRandomBytes) {
  EdgeText text;
  std::mt19937 random(5);
  std::vector<std::uint8_t> noise(4096);
  for (int i = 0; i < 500; ++i) {
    for (auto& byte : noise) byte = static_cast<std::uint8_t>("0123456789\n\r x"[random() % 14]);
    text.feed(kWall_us + i * 1000, noise);
  }
  EXPECT_GT(text.garbage(), 10'000);
}

// ---- devices

struct TextSource : testing::Test {
  TemporaryFolder folder;
  std::string path = folder / "clock";
  std::int64_t wall_us = kWall_us;
  std::function<std::int64_t()> clock = [this] { return wall_us; };

  // What has been written takes no time to arrive.
  std::vector<std::int64_t> arrived(EdgeSource& source, std::int64_t at_us) {
    wall_us = at_us;
    return source.read(0);
  }
};

TEST_F(TextSource, ReadsAPseudoTerminal) {
  PseudoTerminal terminal(path);
  TextEdgeSource source(path, 38400, clock);
  EXPECT_EQ(terminal.baud(), 38400);
  EXPECT_GE(source.wake_fd(), 0);
  EXPECT_TRUE(source.read(0).empty());
  terminal.write(bytes("\n1000\n"));
  EXPECT_EQ(arrived(source, kWall_us), std::vector<std::int64_t>{kWall_us});
  terminal.write(bytes("2000\n3000\n"));
  EXPECT_EQ(arrived(source, kWall_us + 2500),
            (std::vector<std::int64_t>{kWall_us + 1000, kWall_us + 2000}));
}

TEST_F(TextSource, ReadsAFifoWhoseWritersComeAndGo) {
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  TextEdgeSource source(path, 115200, clock);
  EXPECT_TRUE(source.read(0).empty());
  for (int i = 0; i < 3; ++i) {
    std::ofstream(path) << "\n" << 1000 * (i + 1) << "\n";
    EXPECT_EQ(arrived(source, kWall_us + 1000 * i), std::vector<std::int64_t>{kWall_us + 1000 * i});
  }
}

TEST_F(TextSource, SaysWhatIsMissing) {
  try {
    TextEdgeSource source(path, 115200, clock);
    FAIL();
  } catch (const PortError& error) {
    EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos);
  }
  PseudoTerminal terminal(path);
  EXPECT_THROW(TextEdgeSource(path, 12345, clock), PortError);
}

TEST_F(TextSource, IsOpenedAgainWhenItsDeviceWasGone) {
  int opened = 0;
  ReopenedEdgeSource source([&] {
    ++opened;
    return std::make_unique<TextEdgeSource>(path, 115200, clock);
  });
  EXPECT_EQ(source.wake_fd(), -1);
  EXPECT_TRUE(source.read(0).empty());
  EXPECT_NE(source.trouble().find("No such file"), std::string::npos) << source.trouble();
  for (std::int64_t now_us = 0; now_us < 60'000'000; now_us += 20'000) source.read(now_us);
  EXPECT_EQ(opened, 10) << "at 0, 0.5, 1.5, 3.5, 7.5, 15.5, 25.5 ... s";
  {
    PseudoTerminal terminal(path);
    source.read(100'000'000);
    EXPECT_EQ(source.trouble(), "");
    EXPECT_GE(source.wake_fd(), 0);
    terminal.write(bytes("\n1000\n"));
    EXPECT_EQ(source.read(100'000'001).size(), 1u);
  }
  source.read(100'000'002);
  EXPECT_NE(source.trouble(), "");
  EXPECT_EQ(source.wake_fd(), -1);
  PseudoTerminal back(path);
  source.read(100'600'000);
  EXPECT_EQ(source.trouble(), "");
}

TEST_F(TextSource, IsNoModemLine) {
  PseudoTerminal terminal(path);
  EXPECT_THROW(ModemEdgeSource(path, "cts"), PortError) << "a pseudo-terminal has none";
  EXPECT_THROW(ModemEdgeSource(path, "xyz"), std::invalid_argument);
}

}  // namespace
}  // namespace voxlist::serial
