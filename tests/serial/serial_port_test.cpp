#include "voxlist/serial/serial_port.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "tests/temporary_folder.h"
#include "voxlist/serial/adapter_latency.h"
#include "voxlist/serial/pseudo_terminal.h"

namespace voxlist::serial {
namespace {

using test::TemporaryFolder;

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;
using Bytes = std::vector<std::uint8_t>;

constexpr std::int64_t kLong_us = 10'000'000;

struct SerialPortTest : testing::Test {
  Bytes read(SerialPort& port, std::size_t n) {
    Bytes all;
    while (all.size() < n) {
      const auto received = port.read(kLong_us);
      if (!received) break;
      all.insert(all.end(), received->bytes.begin(), received->bytes.end());
    }
    return all;
  }

  // Bytes cross a pseudo-terminal at the system's leisure.
  Bytes read(PseudoTerminal& terminal, std::size_t n) {
    Bytes all;
    for (int i = 0; i < 1'000'000 && all.size() < n; ++i) {
      const Bytes some = terminal.read();
      all.insert(all.end(), some.begin(), some.end());
    }
    return all;
  }

  std::string error_of(const std::string& name) {
    try {
      SerialPort port(name, 9600);
    } catch (const PortError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder;
  std::string path = folder / "scanner";
};

TEST_F(SerialPortTest, CarriesEveryByteBothWays) {
  PseudoTerminal terminal(path);
  SerialPort port(path, 9600);
  Bytes all;
  for (int byte = 0; byte < 256; ++byte) all.push_back(static_cast<std::uint8_t>(byte));
  port.write(all);
  EXPECT_EQ(read(terminal, all.size()), all);
  EXPECT_EQ(terminal.write(all), all.size());
  EXPECT_EQ(read(port, all.size()), all);
}

TEST_F(SerialPortTest, PausesBetweenBytesAtHighSpeed) {
  PseudoTerminal terminal(path);
  SerialPort port(path, 500000);
  const auto start = std::chrono::steady_clock::now();
  port.write(Bytes(21, 0x55));
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::microseconds(20 * 55));
  EXPECT_EQ(read(terminal, 21), Bytes(21, 0x55));
}

TEST_F(SerialPortTest, SetsTheSpeedThatTheOtherEndSees) {
  PseudoTerminal terminal(path);
  SerialPort port(path, 9600);
  EXPECT_EQ(terminal.baud(), 9600);
  for (const int baud : {19200, 38400, 500000}) {
    port.set_baud(baud);
    EXPECT_EQ(terminal.baud(), baud);
  }
}

TEST_F(SerialPortTest, SpeedThatNobodyHasIsAnError) {
  PseudoTerminal terminal(path);
  SerialPort port(path, 9600);
  EXPECT_THAT([&] { port.set_baud(12345); },
              testing::ThrowsMessage<PortError>(AllOf(StartsWith(path), HasSubstr("12345 baud"))));
  EXPECT_EQ(terminal.baud(), 9600);
}

TEST_F(SerialPortTest, NothingComesWhenTheTimeIsOver) {
  PseudoTerminal terminal(path);
  SerialPort port(path, 9600);
  EXPECT_EQ(port.read(1000), std::nullopt);
  EXPECT_EQ(port.read(0), std::nullopt);
}

TEST_F(SerialPortTest, BytesHaveTheTimeWhenTheyWereTaken) {
  PseudoTerminal terminal(path);
  SerialPort port(path, 9600);
  const std::int64_t before_us = port.now_us();
  terminal.write(Bytes{1});
  const auto received = port.read(kLong_us);
  ASSERT_TRUE(received);
  EXPECT_GE(received->utime_us, before_us);
  EXPECT_LE(received->utime_us, port.now_us());
}

TEST_F(SerialPortTest, FlushAndAChangeOfSpeedForgetWhatHasArrived) {
  PseudoTerminal terminal(path);
  SerialPort port(path, 9600);
  for (const bool by_flush : {true, false}) {
    terminal.write(Bytes{1, 2, 3});
    EXPECT_EQ(read(port, 1)[0], 1);  // all of them are in the port now
    terminal.write(Bytes{4});
    pollfd arrived{port.fd(), POLLIN, 0};
    ASSERT_EQ(poll(&arrived, 1, 10'000), 1);
    by_flush ? port.flush() : port.set_baud(38400);
    EXPECT_EQ(port.read(0), std::nullopt);
  }
}

TEST_F(SerialPortTest, UnpluggedInTheMiddleOfAReadSaysSo) {
  auto terminal = std::make_unique<PseudoTerminal>(path);
  SerialPort port(path, 9600);
  terminal->write(Bytes{7});
  EXPECT_THAT(read(port, 1), ElementsAre(7));
  terminal.reset();
  EXPECT_THAT([&] { port.read(kLong_us); },
              testing::ThrowsMessage<PortError>(AllOf(StartsWith(path), HasSubstr("unplugged"))));
  EXPECT_THROW(port.write(Bytes{1}), PortError);
  EXPECT_THROW(port.set_baud(38400), PortError);
}

TEST_F(SerialPortTest, WrongNameSaysWhatToDo) {
  EXPECT_THAT(error_of(folder / "nothing"),
              AllOf(StartsWith(folder / "nothing"), HasSubstr("No such file"),
                    HasSubstr("plug the adapter in"), Not(HasSubstr("\n"))));
}

TEST_F(SerialPortTest, WhatIsNoSerialPortIsRefused) {
  std::ofstream(path) << "text";
  EXPECT_THAT(error_of(path), HasSubstr("no serial port"));
  EXPECT_THAT(error_of("/dev/null"), HasSubstr("no serial port"));
}

TEST_F(SerialPortTest, SecondProgramIsToldThatItIsBusy) {
  PseudoTerminal terminal(path);
  {
    SerialPort port(path, 9600);
    EXPECT_THAT(error_of(path), AllOf(HasSubstr("busy"), HasSubstr("other program")));
  }
  EXPECT_EQ(error_of(path), "");
}

TEST_F(SerialPortTest, MissingPermissionNamesTheGroup) {
  if (geteuid() == 0) GTEST_SKIP() << "root may open everything";
  PseudoTerminal terminal(path);
  ASSERT_EQ(chmod(fs::canonical(path).c_str(), 0), 0);
  EXPECT_THAT(error_of(path), AllOf(HasSubstr("Permission denied"), HasSubstr("dialout")));
}

struct AdapterLatencyTest : testing::Test {
  AdapterLatencyTest() {
    std::ofstream(folder / "ttyUSB7") << "";
    fs::create_symlink("ttyUSB7", fs::path(folder / "scanner"));
    fs::create_directories(folder / "sys/ttyUSB7");
  }
  std::string quicken() { return quicken_adapter(folder / "scanner", folder / "sys"); }

  TemporaryFolder folder;
  std::string timer = folder / "sys/ttyUSB7/latency_timer";
};

TEST_F(AdapterLatencyTest, IsSetToOneMillisecond) {
  std::ofstream(timer) << "16\n";
  EXPECT_EQ(quicken(), "");
  int latency_ms = 0;
  std::ifstream(timer) >> latency_ms;
  EXPECT_EQ(latency_ms, 1);
}

TEST_F(AdapterLatencyTest, ThatCannotBeSetIsAWarningWithAWayOut) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everything";
  std::ofstream(timer) << "16\n";
  fs::permissions(timer, fs::perms::owner_read);
  EXPECT_THAT(quicken(), AllOf(HasSubstr("16 ms"), HasSubstr(timer), HasSubstr("udev")));
}

TEST_F(AdapterLatencyTest, IsNoMatterForOtherPorts) {
  EXPECT_EQ(quicken(), "");
  EXPECT_EQ(quicken_adapter(folder / "nothing", folder / "sys"), "");
}

}  // namespace
}  // namespace voxlist::serial
