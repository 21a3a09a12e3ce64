#include "voxlist/matching/surfaces/plane_fit.h"

#include <Eigen/Eigenvalues>

#include "voxlist/system/check.h"

namespace voxlist::matching {
namespace {

struct Moments {
  std::int64_t n = 0;
  std::int64_t x = 0, y = 0, z = 0;
  std::int64_t xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void add(const Voxel& v) {
    ++n;
    x += v.x, y += v.y, z += v.z;
    xx += v.x * v.x, xy += v.x * v.y, xz += v.x * v.z;
    yy += v.y * v.y, yz += v.y * v.z, zz += v.z * v.z;
  }

  Eigen::Vector3d mean() const {
    return Eigen::Vector3d(double(x), double(y), double(z)) / double(n);
  }

  Eigen::Matrix3d covariance() const {
    Eigen::Matrix3d products;
    products << double(xx), double(xy), double(xz), double(xy), double(yy), double(yz), double(xz),
        double(yz), double(zz);
    return products / double(n) - mean() * mean().transpose();
  }
};

}  // namespace

Plane fit_plane(std::span<const Voxel> voxels) {
  VOXLIST_CHECK(!voxels.empty(), "a plane needs voxels");
  Moments moments;
  for (const Voxel& v : voxels) moments.add(v);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments.covariance());
  return {moments.mean(), axes.eigenvalues().cwiseMax(0.0).cwiseSqrt(), axes.eigenvectors().col(0)};
}

}  // namespace voxlist::matching
