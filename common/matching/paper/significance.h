#pragma once

#include <cstdint>

namespace voxlist::matching {

/// The paper's chance model of an overlap (section IV): the scan's voxels fall on voxels of the
/// map's volume at random, each on another one. The overlap is then hypergeometric. Counts are of
/// voxels of one size.
///
/// The paper's own symbols cross over in equations 3 to 5; here, with M_v the volume in m^3 and eps
/// the voxels' edge:
///   V = M_v / eps^3 (the paper's text: "V / eps^3"), N occupied voxels of the map, n voxels of the
///   scan.
///
/// The value is to be published, not to be decided on: voxels of real scans lie on surfaces and are
/// far from independent, so that most wrong poses in a building look significant too.
struct ChanceModel {
  std::int64_t volume_voxels = 0;  ///< V
  std::int64_t map_voxels = 0;     ///< N <= V
  std::int64_t scan_voxels = 0;    ///< n <= V
};

// All functions throw std::invalid_argument unless 0 <= N <= V, 0 <= n <= V and V >= 1.

/// N / V, the share of the volume that is occupied (equation 3; its M is the count N).
double occupied_share(const ChanceModel& model);

/// n N / V, the expected overlap (equation 4 prints M o / N).
double overlap_mean(const ChanceModel& model);

/// n (N/V) (1 - N/V) (V - n) / (V - 1) (equation 5 with V for its N, and N for its o). 0 when V
/// is 1.
double overlap_variance(const ChanceModel& model);

/// log10 P(X = overlap); -infinity where the overlap cannot occur.
double log10_overlap_probability(const ChanceModel& model, std::int64_t overlap);

/// log10 P(X >= overlap), the significance of one pose: 0 when every scan overlaps as much,
/// -infinity when none can. Stays exact far below the smallest double. Time grows with the standard
/// deviation.
double log10_overlap_tail(const ChanceModel& model, std::int64_t overlap);

/// log10 of the bound K P on the significance of the best of K poses (Bonferroni), which the paper
/// leaves out: the localiser reports the largest overlap that it found. At most 0 (probability 1).
/// Precondition: poses >= 1.
double log10_best_of(double log10_tail, double poses);

/// How many standard deviations above the mean the best of K poses must lie for P_max <= p_max, if
/// overlaps are normally distributed. Preconditions: 0 < p_max < 1, poses >= 1, p_max / poses >
/// 1e-300 (throws otherwise).
double required_z(double p_max, double poses);

}  // namespace voxlist::matching
