#include "voxlist/system/file_parts.h"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/temporary_folder.h"

namespace voxlist {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class Parts : public testing::Test {
 protected:
  void make(const std::string& name) { std::ofstream(folder_ / name) << name; }

  const test::TemporaryFolder folder_;
};

TEST_F(Parts, AreFoundByTheNameOfTheWholeInTheirOrder) {
  for (const std::string name : {"a.lcm.02", "a.lcm.100", "a.lcm.00", "a.lcm.01", "a.lcm.03.bak",
                                 "a.lcm.7", "b.lcm.00", "a.lcm.2024"})
    make(name);
  const FileParts parts = parts_of(folder_ / "a.lcm");
  EXPECT_THAT(parts.files, ElementsAre(folder_ / "a.lcm.00", folder_ / "a.lcm.01",
                                       folder_ / "a.lcm.02", folder_ / "a.lcm.100"));
  EXPECT_EQ(parts.missing.size(), 97u);
}

TEST_F(Parts, ThatAreMissingAreNamed) {
  make("a.lcm.01");
  make("a.lcm.03");
  std::filesystem::create_symlink("nowhere", folder_ / "a.lcm.02");
  EXPECT_THAT(parts_of(folder_ / "a.lcm").missing,
              ElementsAre(folder_ / "a.lcm.00", folder_ / "a.lcm.02"));
}

TEST_F(Parts, AreNotLookedForWhereTheNameIsAFile) {
  make("a.lcm");
  make("a.lcm.00");
  EXPECT_THAT(parts_of(folder_ / "a.lcm").files, ElementsAre(folder_ / "a.lcm"));
  EXPECT_THAT(parts_of(folder_ / "a.lcm.00").files, ElementsAre(folder_ / "a.lcm.00"));
  EXPECT_THAT(parts_of(folder_ / "none").files, ElementsAre(folder_ / "none"));
  EXPECT_THAT(parts_of(folder_ / "none").missing, IsEmpty());
}

TEST_F(Parts, KnowTheirWhole) {
  make("a.lcm.00");
  EXPECT_EQ(whole_of(folder_ / "a.lcm.00"), "");
  make("a.lcm.01");
  EXPECT_EQ(whole_of(folder_ / "a.lcm.00"), folder_ / "a.lcm");
  EXPECT_EQ(whole_of(folder_ / "a.lcm"), "");
}

}  // namespace
}  // namespace voxlist
