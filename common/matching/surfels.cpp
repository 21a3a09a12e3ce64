#include "matching/surfels.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <optional>

namespace voxlist {
namespace {

// Sums over a cube's voxels, coordinates counted from the cube's lowest voxel.
struct Moments {
  std::int64_t n = 0;
  std::int64_t x = 0, y = 0, z = 0;
  std::int64_t xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void add(std::int64_t vx, std::int64_t vy, std::int64_t vz) {
    ++n;
    x += vx, y += vy, z += vz;
    xx += vx * vx, xy += vx * vy, xz += vx * vz;
    yy += vy * vy, yz += vy * vz, zz += vz * vz;
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

std::optional<Surfel> fit_plane(const Voxel& cell, std::int32_t edge, const Moments& moments,
                                double resolution_m, const SurfelConfig& config) {
  if (moments.n < config.min_voxels) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments.covariance());
  const auto deviation_m = [&](int i) {
    return std::sqrt(std::max(0.0, axes.eigenvalues()(i))) * resolution_m;
  };
  if (deviation_m(0) > config.max_thickness_m) return std::nullopt;
  // The lattice itself makes a plane one voxel thick: without it a perfect plane would have
  // infinite flatness.
  const double lattice_m = resolution_m / std::sqrt(12.0);
  if (deviation_m(1) < config.min_flatness * std::hypot(deviation_m(0), lattice_m))
    return std::nullopt;
  const Eigen::Vector3d lowest(cell.x * edge, cell.y * edge, cell.z * edge);
  return Surfel{(lowest + moments.mean() + Eigen::Vector3d::Constant(0.5)) * resolution_m,
                axes.eigenvectors().col(0)};
}

}  // namespace

SurfelMap::SurfelMap(const VoxelMap& map, const SurfelConfig& config) {
  const double block_m = kBlockEdge * map.resolution_m();
  const auto edge =
      kBlockEdge * std::max(1, static_cast<std::int32_t>(std::lround(config.cell_m / block_m)));
  cell_m_ = edge * map.resolution_m();
  const std::int32_t blocks = edge / kBlockEdge;
  std::vector<std::pair<Voxel, Moments>> cubes;
  for (std::size_t i = 0; i < map.block_count(); ++i) {
    const Voxel& block = map.block_position(i);
    const Voxel cell{floor_div(block.x, blocks), floor_div(block.y, blocks),
                     floor_div(block.z, blocks)};
    const auto [found, added] = cells_.try_emplace(cell, static_cast<std::uint32_t>(cubes.size()));
    if (added) cubes.emplace_back(cell, Moments{});
    Moments& moments = cubes[found->second].second;
    VoxelMap::visit_block(block, map.block(i), [&](const Voxel& v) {
      moments.add(v.x - cell.x * edge, v.y - cell.y * edge, v.z - cell.z * edge);
    });
  }
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
  const auto part = [](std::int32_t value) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(value));
  };
  const std::uint64_t key = part(v.x) * 0x9e3779b97f4a7c15u ^ part(v.y) * 0xc2b2ae3d27d4eb4fu ^
                            part(v.z) * 0x165667b19e3779f9u;
  return static_cast<std::size_t>(key ^ (key >> 29));
}

}  // namespace voxlist
