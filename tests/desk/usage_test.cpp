#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <sstream>

#include "services/voxlist/output/console.h"
#include "services/voxlist/output/progress.h"
#include "services/voxlist/output/stop.h"
#include "tests/desk/scan_set.h"

namespace voxlist::desk {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class Usage : public testing::Test {
 protected:
  // The tool must end with code 1 and one line on stderr that has the text.
  void expect_refusal(std::vector<std::string> arguments, const std::string& text) {
    const test::DeskRun run = test::run(std::move(arguments));
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(run.out, "");
    EXPECT_THAT(run.err, AllOf(StartsWith("voxlist: "), HasSubstr(text)));
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
  }

  test::WorkFolder work_;
};

TEST_F(Usage, IsExplainedWithExamplesByEachCommand) {
  for (const std::string command :
       {"import", "map", "extend", "merge", "rebuild", "localise", "evaluate", "edit", "info",
        "export", "octomap", "simulate", "calibrate", "watch", "health", "bus"}) {
    const test::DeskRun run = test::run({command, "--help"});
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.out, HasSubstr("  voxlist " + command + " "));
    EXPECT_EQ(run.err, "");
  }
}

TEST_F(Usage, ThatIsWrongHasAnExitCodeOfItsOwn) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{}, {"nonsense"}, {"map", "x"}, {"map", "x", "-o", "y", "--z"}}) {
    const test::DeskRun run = test::run(arguments);
    EXPECT_GT(run.exit_code, 100);
    EXPECT_THAT(run.err, HasSubstr("--help"));
  }
}

TEST_F(Usage, NamesAWordThatNoCommandKnows) {
  for (const std::string command :
       {"import", "map", "extend", "merge", "rebuild", "localise", "evaluate", "info", "export",
        "octomap", "simulate", "calibrate", "watch", "bus"}) {
    const test::DeskRun run = test::run({command, "a", "b", "-o", "c", "--unheard-of", "d", "e"});
    EXPECT_GT(run.exit_code, 100) << command;
    EXPECT_THAT(run.err, HasSubstr("--unheard-of")) << command;
  }
}

TEST_F(Usage, TellsTheBusOfTheRobotsSettings) {
  test::write_text(work_ / "robot.toml", "[bus]\nprefix = 'a/'\nurl = 'memq://x'\n");
  const test::DeskRun run = test::run({"bus", "--config", work_ / "robot.toml"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out, "url memq://x\nprefix a/\n");
  test::write_text(work_ / "robot.toml", "[bus]\nprefixx = 'a/'\n");
  expect_refusal({"bus", "--config", work_ / "robot.toml"}, "prefixx");
}

TEST_F(Usage, NamesAWordThatIsNoCommand) {
  const test::DeskRun run = test::run({"mpa", "x", "-o", "y"});
  EXPECT_GT(run.exit_code, 100);
  EXPECT_THAT(run.err, HasSubstr("\"mpa\" is no command, it must be one of import, map, "));
  EXPECT_THAT(test::run({"map", "x", "-o", "y", "zz"}).err, HasSubstr("zz"));
}

TEST_F(Usage, EndsWithinASecondOfCtrlCAlsoWhenNobodyLooks) {
  const auto interrupted = [] {
    stop_on_interrupt();
    std::raise(SIGINT);
    for (;;) pause();
  };
  EXPECT_EXIT(interrupted(), testing::ExitedWithCode(kInterrupted), "voxlist: interrupted");
}

TEST_F(Usage, EndsWith130AfterCtrlCWhateverTheCommandSays) {
  stop_on_interrupt();
  std::raise(SIGINT);
  const test::DeskRun run = test::run({"evaluate", work_ / "none", work_ / "none"});
  stop_on_interrupt();
  EXPECT_EQ(run.exit_code, kInterrupted);
}

TEST_F(Usage, SaysThatAnInputIsNotThere) {
  for (const std::string command : {"import", "map"}) {
    expect_refusal({command, work_ / "none", "-o", work_ / "out"}, work_ / "none");
    EXPECT_FALSE(std::filesystem::exists(work_ / "out"));
  }
}

TEST_F(Usage, SaysThatAFolderHasNoScans) {
  std::filesystem::create_directory(work_ / "empty");
  for (const std::string command : {"import", "map"}) {
    expect_refusal({command, work_ / "empty", "-o", work_ / "out"}, "has no scans");
  }
}

TEST_F(Usage, SaysThatAFileIsNoLog) {
  test::write_text(work_ / "letter.txt", "Dear robot,\n");
  expect_refusal({"map", work_ / "letter.txt", "-o", work_ / "out"}, "letter.txt: is no LCM log");
  test::write_text(work_ / "a.bag", "#ROSBAG V2.0\n");
  expect_refusal({"map", work_ / "a.bag", "-o", work_ / "out"}, "a.bag: is a ROS bag");
  test::write_text(work_ / "a.ply", "ply\n");
  expect_refusal({"map", work_ / "a.ply", "-o", work_ / "out"}, "give the folder that holds it");
  test::write_text(work_ / "nothing", "");
  expect_refusal({"map", work_ / "nothing", "-o", work_ / "out"}, "is no LCM log");
  EXPECT_FALSE(std::filesystem::exists(work_ / "out"));
}

TEST_F(Usage, SaysThatTheOutputCannotBeWritten) {
  test::make_scan_set(work_ / "scans");
  test::write_text(work_ / "file", "");
  expect_refusal({"import", work_ / "scans", "-o", work_ / "none/log"}, work_ / "none/log");
  expect_refusal({"import", work_ / "scans", "-o", work_ / "scans"}, "no regular file");
  expect_refusal({"map", work_ / "scans", "-o", work_ / "file"}, "cannot be made a folder");
}

TEST_F(Usage, TakesAwayWhatAKilledRunLeft) {
  test::make_scan_set(work_ / "scans");
  const std::string left = work_ / "a.lcm.tmp-2000000000-0";  // no process has this number
  test::write_text(left, "half");
  EXPECT_EQ(test::run({"import", work_ / "scans", "-o", work_ / "a.lcm"}).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(left));
}

TEST_F(Usage, SaysThatAMapIsNone) {
  test::make_scan_set(work_ / "scans");
  expect_refusal({"localise", work_ / "scans", work_ / "scans", "-o", work_ / "result.csv"},
                 "keyframes.voxlist");
  EXPECT_FALSE(std::filesystem::exists(work_ / "result.csv"));
}

TEST(Console, DrawsOverItselfOnATerminalAndClearsBeforeALine) {
  std::ostringstream out, err;
  Console console(out, err, true);
  console.draw("half");
  console.warn("careful");
  EXPECT_EQ(err.str(), "\rhalf\x1b[K\r\x1b[K\rvoxlist: careful\n");
}

TEST(Progress, IsSilentAboutShortWork) {
  std::ostringstream out, err;
  Console console(out, err, true);
  Progress(console, "working").show(0.5);
  EXPECT_EQ(err.str(), "");
}

}  // namespace
}  // namespace voxlist::desk
