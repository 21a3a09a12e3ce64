#include "voxlist/mapping/graph/loop_choice.h"

#include <algorithm>
#include <map>

namespace voxlist::mapping {
namespace {

// The drive's own way must allow a loop: so many standard deviations, squared. Of right ones, 1 of
// 900 is farther off.
constexpr double kGate2 = 16.0;
// Two loops close a ring if what is missing to it is within so many, squared.
constexpr double kRing2 = 3.5 * 3.5;
// Looks so near (m, of the drive's own way, at both ends) are asked: the drive is exact over that
// way, and whoever is right sees the same things there.
constexpr double kNear_m = 30.0;
// So many other looks must agree, and such a share of those that were asked, each of which counts
// as much as it is sure: a look at ground that it hardly sees says nothing.
constexpr std::size_t kFewestOthers = 3;
constexpr double kLeastShare = 0.6;
// So many of those that agree must be right by what their scans show alone, in the mean. Of 142
// pairs of places on real streets that have nothing in common, one had four looks that agreed; and
// of their 49 groups of two and more, one came to more than this. Together that is some 1 of 7,000,
// if neither favours the other, and known from one case each; 27 of 34 right groups have both.
constexpr double kLeastRight = 0.1;

bool is_allowed(const PoseTree& tree, const PoseEdge& edge) {
  UncertainPose expected = tree.between(edge.from, edge.to);
  expected.covariance += edge.T_from_to.covariance;
  return mahalanobis2(edge.T_from_to.pose, expected) <= kGate2;
}

bool is_near(const PoseTree& tree, const PoseEdge& a, const PoseEdge& b) {
  return tree.way_m(a.from, b.from) <= kNear_m && tree.way_m(a.to, b.to) <= kNear_m;
}

// Whether one loop, there by the other and the drive, says what it says.
bool close_ring(const PoseTree& tree, const PoseEdge& a, const PoseEdge& b) {
  UncertainPose round = tree.between(a.from, b.from) * b.T_from_to * tree.between(b.to, a.to);
  round.covariance += a.T_from_to.covariance;
  return mahalanobis2(a.T_from_to.pose, round) <= kRing2;
}

// What looks say to one loop, itself included: how sure each is at best that was asked, and that
// agrees.
struct Votes {
  std::map<std::size_t, double> asked, agree;

  static double sum(const std::map<std::size_t, double>& looks) {
    double sum = 0.0;
    for (const auto& [look, probability] : looks) sum += probability;
    return sum;
  }

  bool enough() const {
    return agree.size() > kFewestOthers && sum(agree) >= kLeastShare * sum(asked) &&
           sum(agree) >= kLeastRight;
  }
};

void count(const Loop& loop, std::map<std::size_t, double>& looks) {
  double& best = looks[loop.look];
  best = std::max(best, loop.probability);
}

Votes votes_for(const PoseTree& tree, const Loop& loop, std::span<const Loop> others) {
  Votes votes;
  count(loop, votes.agree);
  for (const Loop& other : others) {
    if (!is_near(tree, loop.edge, other.edge)) continue;
    count(other, votes.asked);
    if (other.look != loop.look && close_ring(tree, loop.edge, other.edge))
      count(other, votes.agree);
  }
  return votes;
}

// Drops loops that too few others agree with, until all that are left agree.
std::vector<Loop> agreeing(const PoseTree& tree, std::vector<Loop> loops) {
  for (std::size_t before = loops.size() + 1; loops.size() < before;) {
    before = loops.size();
    std::vector<Loop> kept;
    for (const Loop& loop : loops)
      if (votes_for(tree, loop, loops).enough()) kept.push_back(loop);
    loops = std::move(kept);
  }
  return loops;
}

// Of each look the place that others agree with most.
std::vector<Loop> one_a_look(const PoseTree& tree, const std::vector<Loop>& loops) {
  std::vector<Loop> best;
  std::vector<double> agree;
  for (const Loop& loop : loops) {
    const double votes = Votes::sum(votes_for(tree, loop, loops).agree);
    if (best.empty() || best.back().look != loop.look) {
      best.push_back(loop);
      agree.push_back(votes);
    } else if (votes > agree.back()) {
      best.back() = loop;
      agree.back() = votes;
    }
  }
  return best;
}

}  // namespace

std::vector<Loop> choose_loops(const PoseTree& tree, std::span<const Loop> loops) {
  std::vector<Loop> allowed;
  std::copy_if(loops.begin(), loops.end(), std::back_inserter(allowed),
               [&](const Loop& loop) { return is_allowed(tree, loop.edge); });
  return agreeing(tree, one_a_look(tree, agreeing(tree, std::move(allowed))));
}

std::vector<Loop> refused_loops(const PoseTree& tree, std::span<const Loop> loops) {
  std::vector<Loop> refused;
  std::copy_if(loops.begin(), loops.end(), std::back_inserter(refused),
               [&](const Loop& loop) { return !is_allowed(tree, loop.edge); });
  return agreeing(tree, one_a_look(tree, agreeing(tree, std::move(refused))));
}

std::vector<Loop> keep_fitting(const PoseTree& tree, const std::vector<Pose2>& solved,
                               std::span<const Loop> loops) {
  std::vector<Loop> fitting;
  std::copy_if(loops.begin(), loops.end(), std::back_inserter(fitting),
               [&](const Loop& loop) { return distance2(loop.edge, solved) <= kRing2; });
  return agreeing(tree, std::move(fitting));
}

}  // namespace voxlist::mapping
