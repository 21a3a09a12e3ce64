#include <gmock/gmock.h>

#include <filesystem>

#include "tests/desk/scan_set.h"

namespace voxlist::desk {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

class Evaluate : public testing::Test {
 protected:
  Evaluate() {
    test::write_text(work_ / "poses.csv", "t,x,y,yaw\n0,0,0,0\n1,1,0,0\n2,2,0,0\n3,3,0,0\n");
    // The last position is 0.4 m to the side.
    test::write_text(work_ / "trajectory.tum",
                     "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n3 3 0.4 0 0 0 0 1\n");
  }

  test::WorkFolder work_;
};

TEST_F(Evaluate, PrintsAbsoluteAndRelativeErrors) {
  const test::DeskRun run = test::run({"evaluate", work_ / "trajectory.tum", work_ / "poses.csv"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("4 of 4 poses matched by time"));
  EXPECT_THAT(run.out,
              ContainsRegex("from the first pose on\n  position \\(m\\) +0.2000 +0.1000 "));
  EXPECT_THAT(run.out, ContainsRegex("last position \\(m\\) +0.4000\n"));
  EXPECT_THAT(run.out, ContainsRegex("pose to pose \\(m\\) +0.2309 +0.1333 +0.0000 +0.4000\n"));
}

TEST_F(Evaluate, DrawsBesideTheTrajectoryOrWhereItIsTold) {
  EXPECT_EQ(test::run({"evaluate", work_ / "trajectory.tum", work_ / "poses.csv"}).exit_code, 0);
  EXPECT_GT(std::filesystem::file_size(work_ / "evaluation.png"), 1000u);
  EXPECT_EQ(test::run({"evaluate", work_ / "trajectory.tum", work_ / "poses.csv", "-o",
                       work_ / "plot.png"})
                .exit_code,
            0);
  EXPECT_EQ(test::read_text(work_ / "plot.png"), test::read_text(work_ / "evaluation.png"));
  EXPECT_GT(std::filesystem::file_size(work_ / "evaluation.svg"), 1000u);
  EXPECT_GT(std::filesystem::file_size(work_ / "plot.svg"), 1000u);
}

TEST_F(Evaluate, ReadsTheFormsOfOthersOnBothSides) {
  test::write_text(work_ / "kitti.txt",
                   "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n"
                   "1 0 0 2 0 1 0 0 0 0 1 0\n1 0 0 3 0 1 0 0 0 0 1 0\n");
  test::write_text(work_ / "euroc.csv",
                   "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], "
                   "q_RS_y [], q_RS_z []\n"
                   "0,0,0,0,1,0,0,0\n1000000000,1,0,0,1,0,0,0\n2000000000,2,0,0,1,0,0,0\n"
                   "3000000000,3,0,0,1,0,0,0\n");
  for (const std::string truth : {"kitti.txt", "euroc.csv", "trajectory.tum"}) {
    const test::DeskRun run = test::run({"evaluate", work_ / truth, work_ / "poses.csv"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("4 of 4 poses matched"));
    EXPECT_EQ(test::run({"evaluate", work_ / "trajectory.tum", work_ / truth}).exit_code, 0);
  }
}

TEST_F(Evaluate, TellsWhatIsOddWithATable) {
  test::write_text(work_ / "odd.csv", "t,x,y,yaw\n0,0,0,0\n1,nan,nan,0\n2,2,0,0\n3,3,0,90\n");
  const test::DeskRun run = test::run({"evaluate", work_ / "trajectory.tum", work_ / "odd.csv"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 of 3 poses matched"));
  EXPECT_THAT(run.err, HasSubstr("odd.csv: 1 rows hold no pose"));
  EXPECT_THAT(run.err, HasSubstr("odd.csv: yaw goes up to 90"));
}

TEST_F(Evaluate, WarnsWhenTheErrorsAreOfFewPosesOnly) {
  test::write_text(work_ / "short.tum", "0 0 0 0 0 0 0 1\n");
  const test::DeskRun few = test::run({"evaluate", work_ / "short.tum", work_ / "poses.csv"});
  EXPECT_EQ(few.exit_code, 0);
  EXPECT_THAT(few.err, HasSubstr("only 1 of 4 true poses have a pose of the trajectory"));
  test::write_text(work_ / "short.tum", "0 0 0 0 0 0 0 1\n3 3 0 0 0 0 0 1\n");
  const test::DeskRun half = test::run({"evaluate", work_ / "short.tum", work_ / "poses.csv"});
  EXPECT_EQ(half.exit_code, 0);
  EXPECT_EQ(half.err, "");
}

TEST_F(Evaluate, SaysWhenNothingBelongsTogether) {
  test::write_text(work_ / "poses.csv", "t,x,y,yaw,scan\n1000,0,0,0,77\n1001,1,0,0,78\n");
  const test::DeskRun run = test::run({"evaluate", work_ / "trajectory.tum", work_ / "poses.csv"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("poses.csv: has no pose for any of"));
}

}  // namespace
}  // namespace voxlist::desk
