#include "voxlist/system/version.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voxlist {
namespace {

TEST(Version, IsANumberAndACommitWhereOneIsKnown) {
  EXPECT_THAT(version(),
              testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+( \\([0-9a-f]+\\+?\\))?"));
}

}  // namespace
}  // namespace voxlist
