#include "matching/surfels.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <optional>

namespace voxlist {
namespace {

// Sums over a cube's voxels, coordinates counted from the cube's lowest voxel.
struct Moments {
  std::int64_t n = 0;
  Eigen::Vector<std::int64_t, 3> sum = Eigen::Vector<std::int64_t, 3>::Zero();
  Eigen::Matrix<std::int64_t, 3, 3> products = Eigen::Matrix<std::int64_t, 3, 3>::Zero();

  void add(std::int64_t x, std::int64_t y, std::int64_t z) {
    const Eigen::Vector<std::int64_t, 3> v{x, y, z};
    ++n;
    sum += v;
    products += v * v.transpose();
  }
};

std::optional<Surfel> fit_plane(const Voxel& cell, std::int32_t edge, const Moments& moments, double resolution_m,
                                const SurfelConfig& config) {
  if (moments.n < config.min_voxels) return std::nullopt;
  const double n = static_cast<double>(moments.n);
  const Eigen::Vector3d mean = moments.sum.cast<double>() / n;
  const Eigen::Matrix3d covariance = moments.products.cast<double>() / n - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  const auto deviation_m = [&](int i) { return std::sqrt(std::max(0.0, axes.eigenvalues()(i))) * resolution_m; };
  if (deviation_m(0) > config.max_thickness_m) return std::nullopt;
  // The lattice itself makes a plane one voxel thick: without it a perfect plane would have infinite flatness.
  const double lattice_m = resolution_m / std::sqrt(12.0);
  if (deviation_m(1) < config.min_flatness * std::hypot(deviation_m(0), lattice_m)) return std::nullopt;
  const Eigen::Vector3d lowest(cell.x * edge, cell.y * edge, cell.z * edge);
  return Surfel{(lowest + mean + Eigen::Vector3d::Constant(0.5)) * resolution_m, axes.eigenvectors().col(0)};
}

}  // namespace

SurfelMap::SurfelMap(const VoxelMap& map, const SurfelConfig& config) {
  const auto edge = static_cast<std::int32_t>(std::lround(config.cell_m / map.resolution_m()));
  cell_m_ = edge * map.resolution_m();
  std::vector<std::pair<Voxel, Moments>> cubes;
  map.for_each_voxel([&](const Voxel& v) {
    const Voxel cell{floor_div(v.x, edge), floor_div(v.y, edge), floor_div(v.z, edge)};
    const auto [found, added] = cells_.try_emplace(cell, static_cast<std::uint32_t>(cubes.size()));
    if (added) cubes.emplace_back(cell, Moments{});
    cubes[found->second].second.add(v.x - cell.x * edge, v.y - cell.y * edge, v.z - cell.z * edge);
  });
  for (const auto& [cell, moments] : cubes) {
    if (const auto surfel = fit_plane(cell, edge, moments, map.resolution_m(), config)) {
      cells_[cell] = static_cast<std::uint32_t>(surfels_.size());
      surfels_.push_back(*surfel);
    } else {
      cells_.erase(cell);
    }
  }
}

const Surfel* SurfelMap::find(const Eigen::Vector3d& point) const {
  const auto found = cells_.find(voxel_at(point, cell_m_));
  return found == cells_.end() ? nullptr : &surfels_[found->second];
}

std::size_t SurfelMap::Hash::operator()(const Voxel& v) const {
  const auto part = [](std::int32_t value) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(value)); };
  const std::uint64_t key = part(v.x) * 0x9e3779b97f4a7c15u ^ part(v.y) * 0xc2b2ae3d27d4eb4fu ^ part(v.z) * 0x165667b19e3779f9u;
  return static_cast<std::size_t>(key ^ (key >> 29));
}

}  // namespace voxlist
