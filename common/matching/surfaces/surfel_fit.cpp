#include "voxlist/matching/surfaces/surfel_fit.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>

#include "voxlist/voxels/fast_cell.h"

namespace voxlist::matching {
namespace {

// Sums over voxels.
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

// A plane through voxels, in voxels: standard deviations along its axes, smallest first.
struct Plane {
  Eigen::Vector3d mean, deviations, normal;
};

Plane fit_plane(const Moments& moments) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments.covariance());
  return {moments.mean(), axes.eigenvalues().cwiseMax(0.0).cwiseSqrt(), axes.eigenvectors().col(0)};
}

bool is_surface(const Plane& plane, std::int64_t voxels, double resolution_m,
                const SurfelConfig& config) {
  if (voxels < config.min_voxels) return false;
  if (plane.deviations(0) * resolution_m > config.max_thickness_m) return false;
  // The lattice itself makes a plane one voxel thick: without it a perfect plane would have
  // infinite flatness.
  const double thickness = std::hypot(plane.deviations(0), 1.0 / std::sqrt(12.0));
  return plane.deviations(1) >= config.min_flatness * thickness;
}

// Of a line of n scattered points: the variance across it over n times the variance along it.
double tilt_variance(const Plane& plane, std::size_t voxels) {
  const double across = plane.deviations(0) * plane.deviations(0) + 1.0 / 12.0,
               along = plane.deviations(1) * plane.deviations(1);
  return across / (along * static_cast<double>(voxels));
}

double across(const Plane& plane, const Voxel& v) {
  return plane.normal.dot(Eigen::Vector3d(v.x, v.y, v.z) - plane.mean);
}

struct Split {
  bool two_faces = false;
  double at = 0.0;  // along the plane's normal, from its mean (voxels)
};

// Whether the voxels lie in two layers: the best cut between two means must leave little of the
// variance across the plane. (An even slab would keep a quarter of it, one noisy face a third.)
Split split(const Plane& plane, std::span<const Voxel> voxels, double resolution_m) {
  constexpr double kSmallestGap_m = 0.05, kMostVarianceLeft = 0.2;
  const double total = plane.deviations(0) * plane.deviations(0);
  if (4.0 * total < std::pow(kSmallestGap_m / resolution_m, 2)) return {};
  Split result;
  double low = 0.0, high = 0.0, share = 0.0;
  for (int i = 0; i < 6; ++i) {
    double low_sum = 0.0, high_sum = 0.0;
    int low_n = 0, high_n = 0;
    for (const Voxel& v : voxels) {
      const double t = across(plane, v);
      (t < result.at ? low_sum : high_sum) += t;
      ++(t < result.at ? low_n : high_n);
    }
    if (low_n == 0 || high_n == 0) return {};
    low = low_sum / low_n;
    high = high_sum / high_n;
    share = static_cast<double>(low_n) / static_cast<double>(low_n + high_n);
    const double middle = (low + high) / 2.0;
    if (middle == result.at) break;
    result.at = middle;
  }
  const double between = share * (1.0 - share) * (high - low) * (high - low);
  result.two_faces =
      (high - low) * resolution_m >= kSmallestGap_m && total - between <= kMostVarianceLeft * total;
  return result;
}

// Looks voxels up that lie near each other: mostly in a block that was asked for before. Of blocks
// whose coordinates are even and odd alike, the last one is remembered.
class NearbyLookUp {
 public:
  explicit NearbyLookUp(const VoxelMap& map) : map_(map), per_m_(1.0 / map.resolution_m()) {}

  bool contains(const Eigen::Vector3d& p) {
    const Voxel v = cell_at(p, per_m_), at = block_of(v);
    Known& known = known_[static_cast<std::size_t>((at.x & 1) | (at.y & 1) << 1 | (at.z & 1) << 2)];
    if (!known.block || known.at != at) known = {at, find(at)};
    return ((*known.block)[static_cast<std::size_t>(v.z & 7)] >> ((v.x & 7) + 8 * (v.y & 7)) & 1) !=
           0;
  }

 private:
  struct Known {
    Voxel at;
    const VoxelBlock* block = nullptr;
  };

  const VoxelBlock* find(const Voxel& at) const {
    static constexpr VoxelBlock kNothing{};
    const VoxelBlock* block = map_.find_block(at);
    return block ? block : &kNothing;
  }

  const VoxelMap& map_;
  const double per_m_;
  std::array<Known, 8> known_;
};

// How far rays passed on the way from a point on a surface, in steps, before something else is met:
// the other face of a thin wall, past which there is another room.
int way_free(NearbyLookUp& occupied, NearbyLookUp& passed, const Eigen::Vector3d& from,
             const Eigen::Vector3d& direction) {
  constexpr double kFirst_m = 0.06, kStep_m = 0.02;  // first beyond the surface's own noise
  constexpr int kSteps = 6;
  int free = 0;
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Vector3d p = from + (kFirst_m + i * kStep_m) * direction;
    if (occupied.contains(p)) break;
    free += passed.contains(p);
  }
  return free;
}

// Turns the normal to the side where more was free.
void find_side(const OccupancyMap& map, std::span<const Voxel> voxels, const Voxel& lowest,
               Surfel& surfel) {
  if (map.passed.empty()) return;
  constexpr std::size_t kSamples = 8;
  const std::size_t samples = std::min(kSamples, voxels.size());
  NearbyLookUp occupied(map.occupied), passed(map.passed);
  int balance = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    const Voxel& v = voxels[i * voxels.size() / samples];
    const Eigen::Vector3d p =
        center({lowest.x + v.x, lowest.y + v.y, lowest.z + v.z}, map.occupied.resolution_m());
    const Eigen::Vector3d foot = p - surfel.normal * surfel.normal.dot(p - surfel.mean);
    balance += way_free(occupied, passed, foot, surfel.normal);
    balance -= way_free(occupied, passed, foot, -surfel.normal);
  }
  if (balance < 0) surfel.normal = -surfel.normal;
  surfel.two_sided = static_cast<std::size_t>(std::abs(balance)) < samples;
}

bool make_surfel(const OccupancyMap& map, const Voxel& lowest, std::span<const Voxel> voxels,
                 const Plane& plane, const SurfelConfig& config, Surfel& surfel) {
  const double resolution_m = map.occupied.resolution_m();
  if (!is_surface(plane, static_cast<std::int64_t>(voxels.size()), resolution_m, config))
    return false;
  const Eigen::Vector3d from(lowest.x, lowest.y, lowest.z);
  surfel = {(from + plane.mean + Eigen::Vector3d::Constant(0.5)) * resolution_m, plane.normal,
            tilt_variance(plane, voxels.size())};
  find_side(map, voxels, lowest, surfel);
  return true;
}

Plane fit_plane(std::span<const Voxel> voxels) {
  Moments moments;
  for (const Voxel& v : voxels) moments.add(v);
  return fit_plane(moments);
}

}  // namespace

int fit_surfels(const OccupancyMap& map, const Voxel& lowest, std::span<const Voxel> voxels,
                const SurfelConfig& config, Surfel sides[2]) {
  if (voxels.size() < static_cast<std::size_t>(config.min_voxels)) return 0;
  const Plane plane = fit_plane(voxels);
  const Split cut = split(plane, voxels, map.occupied.resolution_m());
  if (!cut.two_faces) return make_surfel(map, lowest, voxels, plane, config, sides[0]);
  std::vector<Voxel> faces[2];
  for (const Voxel& v : voxels) faces[across(plane, v) < cut.at ? 0 : 1].push_back(v);
  int count = 0;
  for (const auto& face : faces) {
    if (face.size() >= static_cast<std::size_t>(config.min_voxels))
      count += make_surfel(map, lowest, face, fit_plane(face), config, sides[count]);
  }
  return count;
}

}  // namespace voxlist::matching
