#include "voxlist/service/service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <stdexcept>

#include "tests/service/run_folder_fixture.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/health.h"
#include "voxlist/pose_t.hpp"
#include "voxlist/service/instance_lock.h"
#include "voxlist/service/stop.h"
#include "voxlist/system/file_lock.h"
#include "voxlist/system/version.h"

namespace voxlist::service {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

struct Peer {
  std::string name;
  template <class Visitor>
  void visit(Visitor& v) {
    v("name", name, "what it is called");
  }
};

struct CounterConfig {
  int ticks = 3;
  std::vector<Peer> peers;
  template <class Visitor>
  void visit(Visitor& v) {
    v("ticks", ticks, "ticks until it asks for its own end", 1, 100);
  }
  template <class Visitor>
  void visit_root(Visitor& v) {
    v("robot", peers, "one that counts, too");
  }
};

// Publishes once and listens to itself; ends the process by a real SIGTERM after some ticks.
class CounterService {
 public:
  CounterService(bus::Bus& bus, bus::Health&, const CounterConfig& config)
      : ticks_wanted(config.ticks) {
    seen = {};
    bus.subscribe(bus::kPose, [](const pose_t&) { ++seen.messages; });
    bus.publish(bus::kPose, pose_t{});
  }
  void tick(std::int64_t now_us) {
    seen.clock_never_went_back &= now_us >= seen.last_tick_us;
    seen.last_tick_us = now_us;
    if (++seen.ticks == ticks_wanted) std::raise(SIGTERM);
  }
  void stop() { seen.stopped = true; }

  struct Seen {
    int messages = 0;
    int ticks = 0;
    std::int64_t last_tick_us = 0;
    bool clock_never_went_back = true;
    bool stopped = false;
  };
  static Seen seen;

 private:
  int ticks_wanted;
};
CounterService::Seen CounterService::seen;

// As a service whose last save fails.
class FailsAtItsEnd : public CounterService {
 public:
  FailsAtItsEnd(bus::Bus& bus, bus::Health& health, const CounterConfig& config)
      : CounterService(bus, health, config), health_(health) {}
  ~FailsAtItsEnd() { told = health_.message(); }
  void stop() { throw std::runtime_error("/map: no room for the last keyframe"); }

  static std::string told;

 private:
  bus::Health& health_;
};
std::string FailsAtItsEnd::told;

class BrokenService {
 public:
  BrokenService(bus::Bus&, bus::Health&, const CounterConfig&) {
    throw std::runtime_error("map folder /none: cannot be made; choose another");
  }
};

// Has settings that no range tells to be wrong; must not be made.
class PickyService : public BrokenService {
 public:
  using BrokenService::BrokenService;
  static void check(const CounterConfig& config) {
    if (config.ticks == 13) throw std::invalid_argument("ticks must not be 13");
  }
};

class RunService : public WithRunFolder {
 protected:
  // Runs the service with these arguments; keeps what it wrote.
  template <class Service>
  int run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "mapper");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = run_service<Service, CounterConfig>(static_cast<int>(argv.size()), argv.data(),
                                                         {"mapper", "Counts its ticks."});
    out_ = testing::internal::GetCapturedStdout();
    err_ = testing::internal::GetCapturedStderr();
    return code;
  }

  std::string write_config(const std::string& text) {
    std::ofstream(folder_ / "robot.toml") << text;
    return (folder_ / "robot.toml").string();
  }

  std::string out_, err_;
};

TEST_F(RunService, HandlesMessagesTicksAndStopsOnSigterm) {
  EXPECT_EQ(run<CounterService>({"--lcm-url", "memq://"}), 0);
  EXPECT_EQ(CounterService::seen.ticks, 3);
  EXPECT_EQ(CounterService::seen.messages, 1);
  EXPECT_TRUE(CounterService::seen.clock_never_went_back);
  EXPECT_TRUE(CounterService::seen.stopped);
  EXPECT_THAT(out_, IsEmpty());
}

TEST_F(RunService, TellsWhatWentWrongAtItsEndInHealthLogAndExitCode) {
  EXPECT_EQ(run<FailsAtItsEnd>({"--lcm-url", "memq://"}), 1);
  EXPECT_EQ(FailsAtItsEnd::told, "/map: no room for the last keyframe");
  EXPECT_THAT(err_, HasSubstr("mapper: /map: no room for the last keyframe\n"));
}

TEST_F(RunService, TakesItsSettingsFromTheFile) {
  const auto file =
      write_config("[bus]\nurl = 'memq://'\n[mapper]\nticks = 5\n[localiser]\nx = 1\n");
  EXPECT_EQ(run<CounterService>({"--config", file}), 0);
  EXPECT_EQ(CounterService::seen.ticks, 5);
}

TEST_F(RunService, TellsAllThatIsWrongWithTheFileAndDoesNotStart) {
  CounterService::seen = {};
  const auto file = write_config("[mapper]\nticks = 0\ntocks = 1\n[nobody]\n");
  EXPECT_EQ(run<CounterService>({"--config", file}), 1);
  EXPECT_THAT(err_, HasSubstr("mapper: " + file + ":2: mapper.ticks is 0"));
  EXPECT_THAT(err_, HasSubstr("mapper: " + file + ":3: no key mapper.tocks"));
  EXPECT_THAT(err_, HasSubstr("mapper: " + file + ":4: no table [nobody]"));
  EXPECT_EQ(CounterService::seen.ticks, 0);
}

TEST_F(RunService, PrintsTheSettingsInForce) {
  const auto file = write_config("[bus]\nprefix = 'r2/'\n[mapper]\nticks = 5\n");
  setenv("LCM_DEFAULT_URL", "memq://", 1);
  EXPECT_EQ(run<CounterService>({"--config", file, "--print-config"}), 0);
  EXPECT_THAT(out_, StartsWith("[bus]\n"));
  EXPECT_THAT(out_, HasSubstr("url = \"memq://\"\n"));
  EXPECT_THAT(out_, HasSubstr("prefix = \"r2/\"\n"));
  EXPECT_THAT(out_,
              HasSubstr("[mapper]\n# ticks until it asks for its own end (1 to 100)\nticks = 5\n"));
}

TEST_F(RunService, TakesListsThatStandInNoTable) {
  const auto file = write_config("[[robot]]\nname = 'low'\n[mapper]\nticks = 5\n");
  EXPECT_EQ(run<CounterService>({"--config", file, "--print-config"}), 0);
  EXPECT_THAT(out_, HasSubstr("[[robot]]\n# what it is called\nname = \"low\"\n"));
}

TEST_F(RunService, TakesTheUrlFromTheCommandLineBeforeTheEnvironmentBeforeTheFile) {
  const auto file = write_config("[bus]\nurl = 'udpm://1.1.1.1:1'\n");
  EXPECT_EQ(run<CounterService>({"--config", file, "--print-config"}), 0);
  EXPECT_THAT(out_, HasSubstr("url = \"udpm://1.1.1.1:1\"\n"));
  setenv("LCM_DEFAULT_URL", "udpm://2.2.2.2:2", 1);
  EXPECT_EQ(run<CounterService>({"--config", file, "--print-config"}), 0);
  EXPECT_THAT(out_, HasSubstr("url = \"udpm://2.2.2.2:2\"\n"));
  EXPECT_EQ(run<CounterService>({"--config", file, "--print-config", "--lcm-url", "memq://"}), 0);
  EXPECT_THAT(out_, HasSubstr("url = \"memq://\"\n"));
}

TEST_F(RunService, ExplainsItself) {
  EXPECT_EQ(run<CounterService>({"--help"}), 0);
  EXPECT_THAT(out_, HasSubstr("Counts its ticks."));
  EXPECT_THAT(out_, HasSubstr("--print-config"));
}

TEST_F(RunService, RefusesAnOptionThatItDoesNotKnow) {
  EXPECT_EQ(run<CounterService>({"--colour", "red"}), 1);
  EXPECT_THAT(err_, StartsWith("mapper: "));
  EXPECT_THAT(err_, HasSubstr("mapper --help"));
}

TEST_F(RunService, SaysInOneLineWhyItCannotStart) {
  EXPECT_EQ(run<BrokenService>({"--lcm-url", "memq://"}), 1);
  EXPECT_EQ(err_, "mapper: map folder /none: cannot be made; choose another\n");
}

TEST_F(RunService, DoesNotStartBesideAnotherOfItsKindOnTheSameBus) {
  const auto held = FileLock::take(folder_ / lock_name("mapper", "memq://", ""));
  EXPECT_EQ(run<CounterService>({"--lcm-url", "memq://"}), 1);
  EXPECT_EQ(err_, "mapper: already runs on this bus as process " + std::to_string(getpid()) +
                      "; stop that one first\n");
  EXPECT_EQ(run<CounterService>(
                {"--lcm-url", "memq://", "--config", write_config("[bus]\nprefix = 'r2/'\n")}),
            0);
}

TEST_F(RunService, ChecksTheSettingsWithoutMakingTheService) {
  const auto good = write_config("[bus]\nurl = 'memq://'\n[mapper]\nticks = 12\n");
  EXPECT_EQ(run<PickyService>({"--config", good, "--check-config"}), 0);
  EXPECT_EQ(out_ + err_, "");
  const auto file = write_config("[bus]\nprefix = 'a b'\n[mapper]\nticks = 13\n");
  EXPECT_EQ(run<PickyService>({"--config", file, "--check-config"}), 1);
  EXPECT_THAT(err_, HasSubstr("mapper: " + file + ": [bus] channel prefix 'a b'"));
  EXPECT_THAT(err_, HasSubstr("mapper: " + file + ": [mapper] ticks must not be 13\n"));
}

TEST_F(RunService, RefusesUnfitSettingsAtTheStartInTheSameWords) {
  const auto file = write_config("[mapper]\nticks = 13\n");
  EXPECT_EQ(run<PickyService>({"--config", file, "--lcm-url", "memq://"}), 1);
  EXPECT_EQ(err_, "mapper: " + file + ": [mapper] ticks must not be 13\n");
}

TEST_F(RunService, TellsItsVersion) {
  EXPECT_EQ(run<CounterService>({"--version"}), 0);
  EXPECT_EQ(out_, version() + "\n");
}

class StoppedAtItsStart : public CounterService {
 public:
  StoppedAtItsStart(bus::Bus& bus, bus::Health& health, const CounterConfig& config)
      : CounterService(bus, health, config) {
    throw Stopped();
  }
};

TEST_F(RunService, EndsAsWantedWhenItIsStoppedWhileItIsMade) {
  EXPECT_EQ(run<StoppedAtItsStart>({"--lcm-url", "memq://"}), 0);
}

// Works on for ever in its first tick, after it was asked to stop.
class NeverDone : public CounterService {
 public:
  using CounterService::CounterService;
  [[noreturn]] void tick(std::int64_t) {
    std::raise(SIGTERM);
    for (;;) pause();
  }
};

TEST_F(RunService, EndsWithinItsWorkWhenThereIsNothingToSave) {
  std::string name = "mapper", url = "memq://", option = "--lcm-url";
  char* argv[] = {name.data(), option.data(), url.data()};
  const auto run_it = [&] {
    run_service<NeverDone, CounterConfig>(3, argv, {"mapper", "Is never done.", true});
  };
  EXPECT_EXIT(run_it(), testing::ExitedWithCode(0), "stopped within its work");
}

}  // namespace
}  // namespace voxlist::service
