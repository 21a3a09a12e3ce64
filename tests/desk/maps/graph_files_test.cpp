// What holds a map's poses, and how sure they are, for other programs: graph.g2o and
// trajectory_covariance.txt.
#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>
#include <filesystem>
#include <sstream>

#include "services/voxlist/commands/desk.h"
#include "tests/desk/scan_set.h"
#include "tests/mapping/graph/g2o_reader.h"
#include "voxlist/io/poses/trajectory.h"

namespace voxlist::desk {
namespace {

class GraphFiles : public testing::Test {
 protected:
  GraphFiles() { test::make_scan_set(scans_); }

  test::DeskRun desk(std::vector<std::string> arguments) const {
    arguments.push_back("--no-octomap");
    test::DeskRun run = test::run(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run;
  }

  std::string text(const std::string& name) const { return test::read_text(folder_ + "/" + name); }

  // A line of the covariances: time and the half of a symmetric matrix.
  static std::pair<double, Eigen::Matrix3d> parse(const std::string& line) {
    std::istringstream words(line);
    double t_s = 0.0;
    Eigen::Matrix3d matrix;
    words >> t_s;
    for (int row = 0; row < 3; ++row)
      for (int column = row; column < 3; ++column) {
        words >> matrix(row, column);
        matrix(column, row) = matrix(row, column);
      }
    EXPECT_TRUE(words) << line;
    return {t_s, matrix};
  }

  void expect_graph_and_covariances() const {
    const std::string graph = text("graph.g2o");
    const test::G2oFile read(graph);
    EXPECT_TRUE(read.unknown.empty());
    ASSERT_GT(read.vertices.size(), 3U);
    EXPECT_GE(read.edges.size(), read.vertices.size() - 1);
    EXPECT_NEAR(read.chi2(), test::chi2_told(graph), 1e-6 * (1.0 + read.chi2()));
    const auto lines = test::read_lines(folder_ + "/trajectory_covariance.txt");
    const auto trajectory = io::read_tum(folder_ + "/trajectory.tum");
    ASSERT_EQ(lines.size(), trajectory.size() + 1);
    EXPECT_THAT(lines[0], testing::StartsWith("# t_s xx xy xa yy ya aa"));
    for (std::size_t i = 0; i < trajectory.size(); ++i) {
      const auto [t_s, covariance] = parse(lines[i + 1]);
      EXPECT_NEAR(1e6 * t_s, static_cast<double>(trajectory[i].utime_us), 0.6);
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
      EXPECT_GE(axes.eigenvalues().minCoeff(), 0.0) << i;
      EXPECT_LT(axes.eigenvalues().maxCoeff(), 0.25) << i;
    }
    // The first keyframe is exact, and the last scan is no longer.
    EXPECT_EQ(parse(lines[1]).second.norm(), 0.0);
    EXPECT_GT(parse(lines.back()).second.norm(), 0.0);
  }

  test::WorkFolder work_;
  const std::string scans_ = work_ / "scans", folder_ = work_ / "map";
};

TEST_F(GraphFiles, AreThereOfAMapThatNeverCameBack) {
  desk({"map", scans_, "-o", folder_});
  expect_graph_and_covariances();
}

TEST_F(GraphFiles, AreTheSameForAnyNumberOfThreads) {
  desk({"map", scans_, "-o", folder_, "--threads", "1"});
  const std::string graph = text("graph.g2o"), sure = text("trajectory_covariance.txt");
  desk({"map", scans_, "-o", folder_, "--threads", "4"});
  EXPECT_EQ(text("graph.g2o"), graph);
  EXPECT_EQ(text("trajectory_covariance.txt"), sure);
}

TEST_F(GraphFiles, FollowAnExtendedMapAndARebuiltOne) {
  desk({"map", scans_, "-o", folder_});
  test::write_text(work_ / "robot.toml", "[mapper]\nmin_news = 0.0\n");
  const std::size_t before = test::G2oFile(text("graph.g2o")).vertices.size();
  desk({"extend", folder_, scans_, "--config", work_ / "robot.toml"});
  expect_graph_and_covariances();
  EXPECT_GT(test::G2oFile(text("graph.g2o")).vertices.size(), before);
  const std::string sure = text("trajectory_covariance.txt");
  desk({"rebuild", folder_});
  EXPECT_EQ(text("trajectory_covariance.txt"), sure);
}

TEST_F(GraphFiles, AreNotThereWherePosesWereGiven) {
  desk({"map", scans_, "-o", folder_});
  desk({"map", scans_, "-o", folder_, "--use-poses", scans_ + "/poses.csv"});
  EXPECT_FALSE(std::filesystem::exists(folder_ + "/graph.g2o"));
  EXPECT_FALSE(std::filesystem::exists(folder_ + "/trajectory_covariance.txt"));
}

}  // namespace
}  // namespace voxlist::desk
