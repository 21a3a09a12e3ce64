// How sure poses are, and the graph as other programs read it.
#include "voxlist/mapping/graph/pose_covariances.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/mapping/graph/block_drive.h"
#include "tests/mapping/graph/g2o_reader.h"
#include "voxlist/mapping/graph/loop_closing.h"
#include "voxlist/mapping/graph/pose_graph.h"
#include "voxlist/mapping/graph/stored_graph.h"
#include "voxlist/mapping/text/checked_text.h"

namespace voxlist::mapping {
namespace {

std::vector<PoseEdge> edges_of(const std::vector<Loop>& loops) {
  std::vector<PoseEdge> edges;
  for (const Loop& loop : loops) edges.push_back(loop.edge);
  return edges;
}

TEST(PoseCovariances, AreThoseOfTheDenseInverse) {
  const BlockDrive drive(150, 3);
  const std::vector<PoseEdge> loops = edges_of(drive.loops);
  ASSERT_GT(loops.size(), 10U);
  const auto equations = equations_of(drive.truth, drive.steps, loops, Kernel::kGemanMcClure);
  const Eigen::MatrixXd lower(equations.information());
  const Eigen::MatrixXd dense =
      Eigen::MatrixXd(lower.selfadjointView<Eigen::Lower>()).partialPivLu().inverse();
  const auto sparse = covariances(drive.truth, drive.steps, loops);
  ASSERT_EQ(sparse.size(), drive.truth.size());
  EXPECT_TRUE(sparse[0].isZero());
  for (std::size_t i = 1; i < sparse.size(); ++i)
    EXPECT_TRUE(sparse[i].isApprox(dense.block<3, 3>(3 * (i - 1), 3 * (i - 1)), 1e-6)) << i;
}

TEST(PoseCovariances, SolvedPosesErrAsTheySay) {
  double sum = 0.0;
  int poses = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const BlockDrive drive(150, seed);
    const std::vector<PoseEdge> loops = edges_of(drive.loops);
    const auto solved = solve(drive.truth, drive.steps, loops);
    const auto sure = covariances(solved, drive.steps, loops);
    for (std::size_t i = 10; i < solved.size(); i += 10, ++poses)
      sum += mahalanobis2(drive.truth[i], {solved[i], sure[i]});
  }
  EXPECT_GT(poses, 200);
  EXPECT_NEAR(sum / poses, 3.0, 0.5);
}

TEST(PoseCovariances, AScanIsAsSureAsTheKeyframeBesideIt) {
  const std::vector<StampedPose3> keyframes{{0, to_pose3({})}, {10, to_pose3({10.0, 0.0, 0.0})}};
  const std::vector<StampedPose3> scans{
      {0, to_pose3({})}, {8, to_pose3({8.0, 0.0, 0.0})}, {10, to_pose3({10.0, 0.0, 0.0})}};
  const std::vector<Eigen::Matrix3d> sure{Eigen::Matrix3d::Zero(), variance(0.1, 0.05)};
  const auto of_scans = covariances_of(scans, keyframes, sure, {0.02, 0.02, 0.002});
  ASSERT_EQ(of_scans.size(), 3U);
  EXPECT_TRUE(of_scans[0].isZero());
  EXPECT_EQ(of_scans[2], sure[1]);
  // 2 m before the keyframe, whose yaw moves it to the side.
  EXPECT_NEAR(of_scans[1](0, 0), 0.01 + 0.0004, 1e-12);
  EXPECT_NEAR(of_scans[1](1, 1), 0.01 + 0.1 * 0.1 + 0.0004, 1e-12);
  EXPECT_NEAR(of_scans[1](1, 2), -2.0 * 0.0025, 1e-12);
}

TEST(StoredGraph, IsTheSameGraphToAnotherProgram) {
  const BlockDrive drive(150, 3);
  StoredGraph graph{42, 1, {}, drive.steps};
  for (const PoseEdge& edge : edges_of(drive.loops)) graph.edges.push_back(edge);
  // Of no round shape, so that its axes matter.
  for (PoseEdge& edge : graph.edges) edge.T_from_to.covariance(0, 0) *= 30.0;
  const auto solved = solve(drive.truth, graph.edges);
  for (const Pose2& pose : solved) graph.keyframes.push_back({0, pose});
  const std::string text = to_g2o(graph);
  const test::G2oFile read(text);
  EXPECT_TRUE(read.unknown.empty());
  EXPECT_EQ(read.vertices.size(), 150U);
  EXPECT_EQ(read.edges.size(), graph.edges.size());
  EXPECT_EQ(read.fixed, std::vector{0});
  const double solvers = chi2(solved, graph.edges);
  EXPECT_GT(solvers, 10.0);
  EXPECT_NEAR(read.chi2(), solvers, 1e-6 * solvers);
  EXPECT_NEAR(test::chi2_told(text), solvers, 1e-9 * solvers);
}

TEST(StoredGraph, IsReadInItsFirstFormat) {
  StoredGraph graph{42, 1, {{0, {}}, {1, {1.0, 2.0, 1.5}}}, {}};
  graph.edges.push_back({0, 1, {{1.0, 2.0, 1.5}, variance(0.1, 0.2)}});
  graph.edges[0].T_from_to.covariance(0, 0) = 4.0;
  const std::string text = with_checksum(
      "# voxlist graph 1\n# map 42 moves 1\nVERTEX_SE2 0 0 0 0\n# keyframe 0 0 0\n"
      "VERTEX_SE2 1 1 2 1.5\n# keyframe 1 0 0\nFIX 0\nEDGE_SE2 0 1 1 2 1.5 0.25 0 0 100 0 25\n");
  const auto read = parse_g2o(text);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->keyframes[1].T_map_keyframe, (Pose2{1.0, 2.0, 1.5}));
  EXPECT_TRUE(read->edges[0].T_from_to.covariance.isApprox(graph.edges[0].T_from_to.covariance));
  const auto again = parse_g2o(to_g2o(*read));
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->edges[0].T_from_to.covariance.isApprox(graph.edges[0].T_from_to.covariance));
}

}  // namespace
}  // namespace voxlist::mapping
