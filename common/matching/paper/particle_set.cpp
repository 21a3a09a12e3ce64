#include "voxlist/matching/paper/particle_set.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "voxlist/geometry/elementary.h"
#include "voxlist/matching/paper/overlap.h"
#include "voxlist/voxels/occupancy_list.h"

namespace voxlist::matching {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

// Lattice indices first, first + 1, ..., first + count - 1.
struct IndexRange {
  std::int32_t first = 0;
  std::int32_t count = 0;
};

IndexRange positions(const PoseLattice& lattice, double center_m, double half_m) {
  const auto index = [&](double value_m) {
    return static_cast<std::int32_t>(std::lround(
        std::clamp(value_m / lattice.resolution_m(), -double{kVoxelLimit}, double{kVoxelLimit})));
  };
  const std::int32_t first = index(center_m - half_m), last = index(center_m + half_m);
  return {first, last - first + 1};
}

IndexRange headings(const PoseLattice& lattice, double center_rad, double half_rad) {
  if (half_rad >= std::numbers::pi) return {0, lattice.headings()};
  const auto index = [&](double value_rad) {
    return static_cast<std::int32_t>(std::lround(value_rad / lattice.heading_step_rad()));
  };
  const double center = wrap_angle(center_rad);
  const std::int32_t first = index(center - half_rad), last = index(center + half_rad);
  return {first, std::min(last - first + 1, lattice.headings())};
}

std::int32_t wrap(std::int32_t itheta, std::int32_t headings) {
  return itheta - floor_div(itheta, headings) * headings;
}

void check(const PoseWindow& w) {
  const double sum =
      w.center.x_m + w.center.y_m + w.center.yaw_rad + w.half_x_m + w.half_y_m + w.half_yaw_rad;
  if (std::isfinite(sum) && std::min({w.half_x_m, w.half_y_m, w.half_yaw_rad}) >= 0.0) return;
  throw std::invalid_argument("PoseWindow: not finite, or a half width below 0");
}

OccupancyList turned_scan(std::span<const Eigen::Vector3f> points, double yaw_rad,
                          double resolution_m) {
  const auto [s, c] = elementary::sine_cosine(yaw_rad);
  std::vector<Voxel> voxels;
  voxels.reserve(points.size());
  for (const auto& p : points) {
    const Eigen::Vector3d turned(c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z());
    if (in_lattice(turned, resolution_m)) voxels.push_back(voxel_at(turned, resolution_m));
  }
  return {std::move(voxels), resolution_m};
}

bool by_key(const WeightedKey& a, const WeightedKey& b) { return a.key < b.key; }

}  // namespace

PoseLattice::PoseLattice(double resolution_m, double radius_m)
    : resolution_m_(resolution_m),
      headings_(
          std::max(1, static_cast<std::int32_t>(std::ceil(kTwoPi * radius_m / resolution_m)))) {}

PoseLattice PoseLattice::finer() const {
  PoseLattice lattice = *this;
  lattice.resolution_m_ /= 2.0;
  lattice.headings_ *= 2;
  return lattice;
}

double PoseLattice::heading_step_rad() const { return kTwoPi / headings_; }

Pose2 pose_at(const PoseLattice& lattice, const PoseKey& key) {
  return {key.ix * lattice.resolution_m(), key.iy * lattice.resolution_m(),
          wrap_angle(key.itheta * lattice.heading_step_rad())};
}

double horizontal_radius_m(std::span<const Eigen::Vector3f> points_base) {
  double radius_m = 0.0;
  for (const auto& p : points_base) {
    if (in_lattice(p, kFinestResolution_m))
      radius_m = std::max(radius_m, elementary::hypot(double(p.x()), double(p.y())));
  }
  return radius_m;
}

double count_uniform_poses(const PoseLattice& lattice, const PoseWindow& window) {
  check(window);
  return double(positions(lattice, window.center.x_m, window.half_x_m).count) *
         positions(lattice, window.center.y_m, window.half_y_m).count *
         headings(lattice, window.center.yaw_rad, window.half_yaw_rad).count;
}

ParticleSet uniform_poses(const PoseLattice& lattice, const PoseWindow& window) {
  ParticleSet particles;
  particles.reserve(static_cast<std::size_t>(count_uniform_poses(lattice, window)));
  const IndexRange xs = positions(lattice, window.center.x_m, window.half_x_m);
  const IndexRange ys = positions(lattice, window.center.y_m, window.half_y_m);
  const IndexRange thetas = headings(lattice, window.center.yaw_rad, window.half_yaw_rad);
  for (std::int32_t c = 0; c < thetas.count; ++c) {
    for (std::int32_t a = 0; a < xs.count; ++a) {
      for (std::int32_t b = 0; b < ys.count; ++b) {
        particles.push_back(
            {{wrap(thetas.first + c, lattice.headings()), xs.first + a, ys.first + b}, 0});
      }
    }
  }
  std::sort(particles.begin(), particles.end(), by_key);
  return particles;
}

Weighing update_weights(ParticleSet& particles, const PoseLattice& lattice, const VoxelMap& map,
                        std::span<const Eigen::Vector3f> points_base) {
  Weighing weighing;
  OccupancyList turned({}, lattice.resolution_m());
  std::int32_t itheta = -1;
  for (WeightedKey& particle : particles) {
    if (particle.key.itheta != itheta) {
      itheta = particle.key.itheta;
      turned =
          turned_scan(points_base, itheta * lattice.heading_step_rad(), lattice.resolution_m());
      ++weighing.rotations;
    }
    particle.weight = overlap(turned.voxels(), map, {particle.key.ix, particle.key.iy, 0});
    weighing.max_weight = std::max(weighing.max_weight, particle.weight);
    weighing.look_ups += static_cast<std::int64_t>(turned.size());
  }
  return weighing;
}

void prune(ParticleSet& particles, double share, int max_weight) {
  std::erase_if(particles, [&](const WeightedKey& p) {
    return p.weight == 0 || p.weight < share * max_weight;
  });
}

bool keep_heaviest(ParticleSet& particles, std::size_t count) {
  if (particles.size() <= count) return false;
  const auto heavier = [](const WeightedKey& a, const WeightedKey& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.key < b.key;
  };
  std::nth_element(particles.begin(), particles.begin() + static_cast<std::ptrdiff_t>(count),
                   particles.end(), heavier);
  particles.resize(count);
  std::sort(particles.begin(), particles.end(), by_key);
  return true;
}

ParticleSet resample(const ParticleSet& particles, const PoseLattice& finer) {
  std::vector<PoseKey> keys;
  keys.reserve(kChildren * particles.size());
  for (const auto& [key, weight] : particles) {
    for (std::int32_t a = -1; a <= 1; ++a) {
      for (std::int32_t b = -1; b <= 1; ++b) {
        for (std::int32_t c = -1; c <= 1; ++c) {
          keys.push_back(
              {wrap(2 * key.itheta + c, finer.headings()), 2 * key.ix + a, 2 * key.iy + b});
        }
      }
    }
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  ParticleSet children;
  children.reserve(keys.size());
  for (const PoseKey& key : keys) children.push_back({key, 0});
  return children;
}

}  // namespace voxlist::matching
