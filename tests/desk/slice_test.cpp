// `voxlist slice`: a map cut at a height, as a picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/desk/scan_set.h"

namespace voxlist::desk {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class Slice : public testing::Test {
 protected:
  Slice() {
    test::make_scan_set(scans_);
    const test::DeskRun run = test::run(
        {"map", scans_, "-o", map_, "--use-poses", scans_ + "/poses.csv", "--no-octomap"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }

  // The picture that it draws.
  std::string drawn(std::vector<std::string> arguments) {
    const std::string file = work_ / "slice.png";
    arguments.insert(arguments.begin(), {"slice", map_, "-o", file});
    const test::DeskRun run = test::run(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out, file + "\n");
    return test::read_text(file);
  }

  test::WorkFolder work_;
  const std::string scans_ = work_ / "scans", map_ = work_ / "map";
};

TEST_F(Slice, DrawsTheHeightThatIsAskedFor) {
  const std::string low = drawn({"0.5"});
  EXPECT_THAT(low, StartsWith("\x89PNG"));
  EXPECT_TRUE(drawn({"0.5"}) == low);
  EXPECT_FALSE(drawn({"50"}) == low);
}

TEST_F(Slice, DrawsWithAndWithoutWhatHasGone) {
  EXPECT_FALSE(drawn({"0.5", "--both"}) == drawn({"0.5", "--carve"}));
}

TEST_F(Slice, RefusesOtherKindsOfFiles) {
  const test::DeskRun run = test::run({"slice", map_, "0.5", "-o", work_ / "slice.jpg"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("is no .png"));
}

}  // namespace
}  // namespace voxlist::desk
