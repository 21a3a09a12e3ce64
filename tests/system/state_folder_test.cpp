#include "voxlist/system/state_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>

namespace voxlist {
namespace {

// The environment is the process's: each test says all of it. Empty is as good as not set.
void set_environment(const char* state_directory, const char* xdg_state_home, const char* home) {
  setenv("STATE_DIRECTORY", state_directory, 1);
  setenv("XDG_STATE_HOME", xdg_state_home, 1);
  setenv("HOME", home, 1);
}

TEST(StateFolder, IsTheUnitsThenTheUsers) {
  set_environment("/var/lib/voxlist", "/xdg", "/home/robot");
  EXPECT_EQ(state_folder(), "/var/lib/voxlist");
  set_environment("", "/xdg", "/home/robot");
  EXPECT_EQ(state_folder(), "/xdg/voxlist");
  set_environment("", "", "/home/robot");
  EXPECT_EQ(state_folder(), "/home/robot/.local/state/voxlist");
  set_environment("", "", "");
  EXPECT_THROW(state_folder(), std::runtime_error);
}

TEST(StateFolder, HoldsRelativeFoldersAndNoOthers) {
  set_environment("", "/xdg", "");
  EXPECT_EQ(in_state_folder("map"), "/xdg/voxlist/map");
  EXPECT_EQ(in_state_folder("/data/map"), "/data/map");
  EXPECT_EQ(in_state_folder(""), "");
}

}  // namespace
}  // namespace voxlist
