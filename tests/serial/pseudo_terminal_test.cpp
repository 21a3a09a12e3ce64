#include "voxlist/serial/pseudo_terminal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/temporary_folder.h"
#include "voxlist/serial/serial_port.h"

namespace voxlist::serial {
namespace {

using test::TemporaryFolder;

namespace fs = std::filesystem;
using testing::IsEmpty;
using Bytes = std::vector<std::uint8_t>;

struct PseudoTerminalTest : testing::Test {
  TemporaryFolder folder;
  std::string path = folder / "scanner";
};

TEST_F(PseudoTerminalTest, KnowsWhetherSomebodyHasItOpen) {
  PseudoTerminal terminal(path);
  EXPECT_FALSE(terminal.is_open());
  {
    SerialPort port(path, 9600);
    EXPECT_TRUE(terminal.is_open());
  }
  EXPECT_FALSE(terminal.is_open());
  SerialPort again(path, 38400);
  EXPECT_TRUE(terminal.is_open());
  EXPECT_EQ(terminal.baud(), 38400);
}

TEST_F(PseudoTerminalTest, LinkIsThereAsLongAsIt) {
  {
    PseudoTerminal terminal(path);
    EXPECT_TRUE(fs::is_symlink(path));
    EXPECT_TRUE(fs::is_character_file(path));
    EXPECT_EQ(terminal.link(), path);
  }
  EXPECT_FALSE(fs::exists(fs::symlink_status(path)));
}

TEST_F(PseudoTerminalTest, LinkThatWasLeftIsReplacedAndANewerOneIsLeftAlone) {
  fs::create_symlink("/nowhere", path);
  auto old = std::make_unique<PseudoTerminal>(path);
  PseudoTerminal newer(path);
  const fs::path target = fs::read_symlink(path);
  old.reset();
  EXPECT_EQ(fs::read_symlink(path), target);
  SerialPort port(path, 9600);
  EXPECT_TRUE(newer.is_open());
}

TEST_F(PseudoTerminalTest, FileOfThatNameIsNotReplaced) {
  std::ofstream(path) << "mine";
  EXPECT_THROW(PseudoTerminal{path}, PortError);
  EXPECT_TRUE(fs::is_regular_file(path));
  EXPECT_THROW(PseudoTerminal{folder / "no/such/folder"}, PortError);
}

TEST_F(PseudoTerminalTest, NeverWaits) {
  PseudoTerminal terminal(path);
  EXPECT_THAT(terminal.read(), IsEmpty());
  EXPECT_EQ(terminal.write(Bytes(100)), 100u);  // to nobody
  SerialPort port(path, 9600);
  EXPECT_EQ(port.read(0), std::nullopt);
  EXPECT_THAT(terminal.read(), IsEmpty());
  std::size_t taken = 0;
  for (int i = 0; i < 10'000; ++i) taken += terminal.write(Bytes(1000));
  EXPECT_GT(taken, 1000u);
  EXPECT_LT(taken, 1'000'000u);
}

TEST_F(PseudoTerminalTest, SaysNoEcho) {
  PseudoTerminal terminal(path);
  SerialPort port(path, 9600);
  terminal.write(Bytes{'a', '\n', 3, 4});
  ASSERT_TRUE(port.read(10'000'000));
  EXPECT_THAT(terminal.read(), IsEmpty());
}

}  // namespace
}  // namespace voxlist::serial
