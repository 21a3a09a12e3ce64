#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/desk/scan_set.h"

namespace voxlist::desk {
namespace {

// A run of the tool on a machine of another kind, or as near to it as this one comes. glibc takes
// other variants of its functions where it may not use FMA and AVX2.
struct Machine {
  const char* name;
  const char* environment;
  const char* arguments;
};
constexpr std::array kMachines{
    Machine{"as it is", "", ""},
    Machine{"a libm without FMA", "GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2", ""},
    Machine{"1 thread", "", "--threads 1"},
    Machine{"2 threads", "", "--threads 2"},
    Machine{"4 threads", "", "--threads 4"},
    Machine{"portable instructions", "VOXLIST_INSTRUCTIONS=portable", ""},
    Machine{"AVX2", "VOXLIST_INSTRUCTIONS=avx2", ""},
    Machine{"AVX-512 where there is one", "VOXLIST_INSTRUCTIONS=avx512", ""},
};

// In a process of its own: the C library chooses its functions when a program starts.
bool run_tool(const Machine& machine, const std::string& arguments) {
  const std::string command = std::string("env ") + machine.environment + " '" + VOXLIST_BIN_DIR +
                              "/voxlist' " + arguments + " > /dev/null";
  return std::system(command.c_str()) == 0;
}

std::string map_hash(const Machine& machine, const std::string& input, const std::string& folder) {
  const std::string arguments =
      "map '" + input + "' -o '" + folder + "' --octomap-resolution 1 " + machine.arguments;
  if (!run_tool(machine, arguments)) return "no map";
  return nlohmann::json::parse(test::read_text(folder + "/summary.json"))["map_hash"];
}

// A hash that differs here says that a map is no longer the same on every machine, or that mapping
// has changed. In the latter case all of a test's machines agree, and the new hash belongs here.
constexpr const char* kFloorHash = "cf174e1f7ceb8230";
constexpr const char* kHallHash = "17fe0d8e311cc484";

TEST(GoldenMap, ASimulatedFloorIsTheSameOnEveryMachine) {
  const test::WorkFolder work;
  for (const Machine& machine : kMachines) {
    const std::string log = work / "log";
    ASSERT_TRUE(run_tool(machine, "simulate --seconds 20 -o '" + log + "'")) << machine.name;
    EXPECT_EQ(map_hash(machine, log, work / "map"), kFloorHash) << machine.name;
  }
}

// Takes a minute or two.
TEST(GoldenMap, TheHallIsTheSameOnEveryMachine) {
  const char* data = std::getenv("VOXLIST_DATA");
  const std::string hall =
      std::string(data ? data : VOXLIST_SOURCE_DIR "/../shared/data") + "/hall";
  if (!std::filesystem::exists(hall)) GTEST_SKIP() << hall << " is not there: set VOXLIST_DATA";
  const test::WorkFolder work;
  for (const Machine& machine : kMachines)
    EXPECT_EQ(map_hash(machine, hall, work / "map"), kHallHash) << machine.name;
}

}  // namespace
}  // namespace voxlist::desk
