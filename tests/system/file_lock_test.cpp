#include "voxlist/system/file_lock.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <stdexcept>

#include "tests/temporary_folder.h"

namespace voxlist {
namespace {

TEST(FileLock, IsHeldByOneOnly) {
  const test::TemporaryFolder folder;
  const auto first = FileLock::take(folder / "a.lock");
  ASSERT_TRUE(first);
  EXPECT_FALSE(FileLock::take(folder / "a.lock"));
  EXPECT_TRUE(FileLock::take(folder / "b.lock"));
}

TEST(FileLock, IsFreeAgainWhenItsOwnerIsGone) {
  const test::TemporaryFolder folder;
  { const auto first = FileLock::take(folder / "a.lock"); }
  EXPECT_TRUE(FileLock::take(folder / "a.lock"));
}

TEST(FileLock, TellsWhoHoldsIt) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(lock_owner(folder / "a.lock"), "?");
  const auto lock = FileLock::take(folder / "a.lock");
  EXPECT_EQ(lock_owner(folder / "a.lock"), std::to_string(getpid()));
}

TEST(FileLock, SaysWhereItCannotBeWritten) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(FileLock::take(folder / "no" / "a.lock"), std::runtime_error);
}

TEST(FileLock, CanBeLookedAtWithoutTakingIt) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(is_locked(folder / "a.lock"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.lock"));
  {
    const auto lock = FileLock::take(folder / "a.lock");
    EXPECT_TRUE(is_locked(folder / "a.lock"));
  }
  EXPECT_FALSE(is_locked(folder / "a.lock"));
}

}  // namespace
}  // namespace voxlist
