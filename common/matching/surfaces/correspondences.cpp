#include "voxlist/matching/surfaces/correspondences.h"

#include "voxlist/system/check.h"

namespace voxlist::matching {

template <int kDof>
void find_correspondences(const SurfelMap& surfels, const RayPoints& scan, const Pose3& pose,
                          double scale_m, LookUps& look_ups,
                          std::vector<Correspondence<kDof>>& found) {
  VOXLIST_CHECK(look_ups.size() == scan.points.size(), "a look-up for each point is needed");
  found.clear();
  found.reserve(scan.points.size());
  const Eigen::Matrix3d turn = pose.linear();
  const Eigen::Vector3d base = pose.translation();
  const double scale2 = scale_m * scale_m;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3d arm = turn * scan.points[i].cast<double>(), p = base + arm;
    const Eigen::Vector3d origin =
        scan.origins.empty() ? base : (base + turn * scan.origins[i].cast<double>()).eval();
    const Surfel* surfel = surfels.find(p, origin, look_ups[i]);
    if (!surfel) continue;
    const double residual = surfel->normal.dot(p - surfel->mean);
    const double falloff = scale2 / (scale2 + residual * residual);
    found.push_back({surfel, arm, slope<kDof>(surfel->normal, arm), residual, falloff * falloff});
  }
}

template void find_correspondences(const SurfelMap&, const RayPoints&, const Pose3&, double,
                                   LookUps&, std::vector<Correspondence<3>>&);
template void find_correspondences(const SurfelMap&, const RayPoints&, const Pose3&, double,
                                   LookUps&, std::vector<Correspondence<6>>&);

}  // namespace voxlist::matching
