#include "voxlist/service/instance_lock.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <stdexcept>

#include "tests/service/run_folder_fixture.h"
#include "voxlist/service/run_folder.h"

namespace voxlist::service {
namespace {

class Lock : public WithRunFolder {};
class RunFolder : public WithRunFolder {};

TEST_F(Lock, HasANameForEachServiceOnEachBus) {
  const auto name = lock_name("mapper", "udpm://239.255.76.67:7667?ttl=0", "");
  EXPECT_EQ(name, lock_name("mapper", "udpm://239.255.76.67:7667?ttl=1", ""));
  EXPECT_NE(name, lock_name("localiser", "udpm://239.255.76.67:7667?ttl=0", ""));
  EXPECT_NE(name, lock_name("mapper", "udpm://239.255.76.67:7668?ttl=0", ""));
  EXPECT_NE(name, lock_name("mapper", "udpm://239.255.76.67:7667?ttl=0", "robot_2/"));
  EXPECT_EQ(name.find('/'), std::string::npos);
}

TEST_F(RunFolder, IsMadeWhereTheEnvironmentSays) {
  setenv("VOXLIST_RUN_DIR", (folder_ / "run").c_str(), 1);
  EXPECT_EQ(run_folder(), folder_ / "run");
  struct stat info;
  ASSERT_EQ(stat((folder_ / "run").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0700U);
}

TEST_F(RunFolder, IsRefusedWhenItIsNoFolder) {
  std::filesystem::create_symlink("/tmp", folder_ / "link");
  setenv("VOXLIST_RUN_DIR", (folder_ / "link").c_str(), 1);
  EXPECT_THROW(run_folder(), std::runtime_error);
}

}  // namespace
}  // namespace voxlist::service
