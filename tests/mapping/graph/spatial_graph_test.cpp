// A graph of poses in all six coordinates, and its file.
#include "voxlist/mapping/graph/spatial_graph.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <sstream>

#include "tests/mapping/graph/g2o_reader.h"
#include "voxlist/mapping/graph/spatial_g2o.h"
#include "voxlist/simulation/random.h"

namespace voxlist::mapping {
namespace {

// Up and down ramps, round and round.
std::vector<Pose3> spiral(std::size_t poses) {
  std::vector<Pose3> spiral;
  for (std::size_t i = 0; i < poses; ++i) {
    const double angle = 0.3 * static_cast<double>(i);
    spiral.push_back(to_pose3({5.0 * std::cos(angle), 5.0 * std::sin(angle), angle + 1.6},
                              {0.1 * static_cast<double>(i), 0.02, -0.1}));
  }
  return spiral;
}

Six2 covariance_of(simulation::Random& random) {
  Six2 root = Six2::Zero();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j) root(i, j) = (i == j ? 0.02 : 0.004) + 0.004 * random.normal();
  return root * root.transpose();
}

std::vector<SpatialEdge> edges_of(const std::vector<Pose3>& truth, simulation::Random& random) {
  std::vector<SpatialEdge> edges;
  const auto add = [&](std::size_t from, std::size_t to) {
    edges.push_back({from, to, {truth[from].inverse() * truth[to], covariance_of(random)}});
  };
  for (std::size_t i = 1; i < truth.size(); ++i) add(i - 1, i);
  add(0, truth.size() - 1);
  add(truth.size() - 3, 2);
  return edges;
}

TEST(SpatialGraph, PosesThatFitAllEdgesAreFoundFromAfar) {
  simulation::Random random(5);
  const std::vector<Pose3> truth = spiral(40);
  const auto edges = edges_of(truth, random);
  std::vector<Pose3> start = truth;
  for (std::size_t i = 1; i < start.size(); ++i) {
    Six step;
    for (double& part : step) part = 0.2 * random.normal();
    start[i] = stepped(start[i], step);
  }
  const std::vector<Pose3> solved = solve(start, edges);
  for (std::size_t i = 0; i < truth.size(); ++i)
    EXPECT_LT(miss(truth[i], Pose3::Identity(), solved[i]).norm(), 1e-5) << i;
  EXPECT_EQ(solved.front().matrix(), truth.front().matrix());
}

TEST(SpatialGraph, NoSmallMotionMakesTheSolvedPosesFitBetter) {
  simulation::Random random(6);
  const std::vector<Pose3> truth = spiral(12);
  auto edges = edges_of(truth, random);
  for (SpatialEdge& edge : edges) {
    Six step;
    for (double& part : step) part = 0.02 * random.normal();
    edge.T_from_to.pose = stepped(edge.T_from_to.pose, step);
  }
  const std::vector<Pose3> solved = solve(truth, edges);
  const auto chi2_at = [&](const std::vector<Pose3>& poses) {
    double sum = 0.0;
    for (const SpatialEdge& edge : edges) sum += distance2(edge, poses);
    return sum;
  };
  for (int part = 0; part < 6; ++part)
    for (const double by : {0.003, -0.003}) {
      std::vector<Pose3> other = solved;
      other[5] = stepped(other[5], by * Six::Unit(part));
      EXPECT_GT(chi2_at(other), chi2_at(solved)) << part;
    }
}

TEST(SpatialGraph, AnEdgeSaysTheSameOfRobotsAsTheyLean) {
  simulation::Random random(7);
  const Tilt a{0.4, 0.1, -0.2}, b{1.1, -0.05, 0.15};
  const Pose3 from = to_pose3({1.0, 2.0, 0.5}),
              to = stepped(to_pose3({3.0, 2.5, 1.0}), Six::Constant(0.03));
  const SpatialEdge level{
      0, 1, {stepped(from.inverse() * to, Six::Constant(0.01)), covariance_of(random)}};
  const SpatialEdge leaning{0, 1, between_leaning(level.T_from_to, a, b)};
  // Exact for small misses.
  EXPECT_NEAR(
      distance2(leaning, {from * to_level(a), to * to_level(b)}) / distance2(level, {from, to}),
      1.0, 0.02);
}

StoredGraph graph_in_space() {
  simulation::Random random(8);
  const std::vector<Pose3> truth = spiral(9);
  StoredGraph graph{42, 3, {}, {}};
  for (std::size_t i = 0; i < truth.size(); ++i)
    graph.keyframes.push_back({.utime_us = static_cast<std::int64_t>(i),
                               .T_map_keyframe = to_pose2(truth[i]),
                               .tilt = tilt_of(truth[i])});
  graph.keyframes[2].T_odom_keyframe = Pose2{1.0 / 3.0, 2.0, 3.0};
  for (SpatialEdge edge : edges_of(truth, random)) {
    edge.T_from_to.pose = stepped(edge.T_from_to.pose, Six::Constant(0.01));
    graph.edges.push_back({edge.from,
                           edge.to,
                           {to_pose2(edge.T_from_to.pose), Eigen::Matrix3d::Identity()},
                           edge.T_from_to});
  }
  return graph;
}

TEST(SpatialGraph, IsReadAsItWasWritten) {
  const StoredGraph graph = graph_in_space();
  const std::string text = to_g2o(graph);
  const auto read = parse_g2o(text);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->keyframes.size(), graph.keyframes.size());
  for (std::size_t i = 0; i < graph.keyframes.size(); ++i) {
    EXPECT_EQ(read->keyframes[i].T_map_keyframe, graph.keyframes[i].T_map_keyframe);
    EXPECT_EQ(read->keyframes[i].tilt, graph.keyframes[i].tilt);
    EXPECT_EQ(read->keyframes[i].T_odom_keyframe, graph.keyframes[i].T_odom_keyframe);
  }
  ASSERT_EQ(read->edges.size(), graph.edges.size());
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    EXPECT_EQ(read->edges[i].T_from_to.pose, graph.edges[i].T_from_to.pose);
    ASSERT_TRUE(read->edges[i].in_space);
    EXPECT_TRUE(read->edges[i].in_space->pose.isApprox(graph.edges[i].in_space->pose, 1e-9));
    EXPECT_TRUE(
        read->edges[i].in_space->covariance.isApprox(graph.edges[i].in_space->covariance, 1e-6));
  }
  for (std::size_t length = 0; length + 1 < text.size(); length += 37)
    EXPECT_FALSE(parse_g2o(text.substr(0, length))) << length;
}

// As g2o's EDGE_SE3:QUAT has it: the miss is the pose of what is seen as what was told would see
// it, its turn the first three parts of a quaternion.
double chi2_by_others(const std::string& text) {
  const auto read = [](std::istringstream& words) {
    Pose3 pose = Pose3::Identity();
    Eigen::Quaterniond turn;
    words >> pose.translation().x() >> pose.translation().y() >> pose.translation().z();
    words >> turn.x() >> turn.y() >> turn.z() >> turn.w();
    pose.linear() = turn.toRotationMatrix();
    return pose;
  };
  std::map<int, Pose3> vertices;
  double sum = 0.0;
  std::istringstream lines(text);
  for (std::string line, tag; std::getline(lines, line);) {
    std::istringstream words(line);
    int from = 0, to = 0;
    words >> tag >> from;
    if (tag == "VERTEX_SE3:QUAT") vertices[from] = read(words);
    if (tag != "EDGE_SE3:QUAT") continue;
    words >> to;
    const Pose3 off = read(words).inverse() * vertices.at(from).inverse() * vertices.at(to);
    const Eigen::Quaterniond turn(off.linear());
    Six missed;
    missed << off.translation(), turn.vec() * (turn.w() < 0.0 ? -1.0 : 1.0);
    Six2 information;
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column) {
        words >> information(row, column);
        information(column, row) = information(row, column);
      }
    sum += missed.dot(information * missed);
  }
  return sum;
}

TEST(SpatialGraph, IsTheSameGraphToOtherPrograms) {
  const std::string text = to_g2o(graph_in_space());
  EXPECT_NEAR(chi2_by_others(text) / test::chi2_told(text), 1.0, 1e-3);
  EXPECT_GT(chi2_by_others(text), 1.0);
}

TEST(SpatialGraph, PutsAKeyframeWhereItStandsAndLeans) {
  const StoredGraph::Keyframe keyframe{
      .utime_us = 1, .T_map_keyframe = {1.0, 2.0, 0.5}, .tilt = Tilt{0.3, 0.0, 0.1}};
  Pose3 pose = to_pose3(keyframe.T_map_keyframe, {0.2, 0.0, 0.1});
  stand_at(keyframe, pose);
  EXPECT_EQ(tilt_of(pose).z_m, 0.3);
  const Pose3 before = pose;
  stand_at(keyframe, pose);
  EXPECT_EQ(pose.matrix(), before.matrix());
}

}  // namespace
}  // namespace voxlist::mapping
