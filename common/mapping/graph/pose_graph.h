#pragma once

#include <span>
#include <vector>

#include "voxlist/mapping/graph/normal_equations.h"
#include "voxlist/mapping/graph/pose_edge.h"

namespace voxlist::mapping {

/// How hard an edge pulls that the others contradict.
enum class Kernel {
  /// As hard as it can: the square of its distance counts.
  kSquare,
  /// Less the farther it is off, but always a little.
  kCauchy,
  /// Hardly at all where it is far off: needs a start that is nearly right.
  kGemanMcClure,
};

/// The share of its pull that a kernel leaves to an edge at that distance (distance2), 0..1.
double weight(Kernel kernel, double distance2);

/// What edges say of small changes (m, m, rad; in the map's axes) of the poses but the first, where
/// the poses stand. Trusted edges count in full, doubted ones as the kernel says.
NormalEquations<3> equations_of(const std::vector<Pose2>& poses, std::span<const PoseEdge> trusted,
                                std::span<const PoseEdge> doubted, Kernel kernel);

/// The squares of all that the poses miss the edges by, in units of the edges' standard deviations:
/// some 3 (edges - poses + 1) where edges err as they say.
double chi2(const std::vector<Pose2>& poses, std::span<const PoseEdge> edges);

/// The poses that fit best what the edges say (least squares, Gauss-Newton), from a start. The
/// first pose stays where it is, and so does one that no edge holds. Trusted edges count in full,
/// doubted ones as the kernel says. Sums go in the order of the edges, in one thread, without BLAS:
/// the same bits on every machine. 10,000 poses take some 0.1 s.
std::vector<Pose2> solve(std::vector<Pose2> poses, std::span<const PoseEdge> trusted,
                         std::span<const PoseEdge> doubted = {}, Kernel kernel = Kernel::kSquare);

/// A pose in steps of 0.1 mm and 0.001 deg: what a map is made anew at, so that a last digit moves
/// no voxel.
Pose2 rounded(const Pose2& pose);

}  // namespace voxlist::mapping
