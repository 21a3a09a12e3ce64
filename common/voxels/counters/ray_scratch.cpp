#include "voxlist/voxels/counters/ray_scratch.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace voxlist {
namespace {

// Rays between two looks at whether to stop: of 1000 cells they take a millisecond.
constexpr std::size_t kRaysAtOnce = 256;

// How often the reach is halved in the search for the farthest that fits.
constexpr int kReachSteps = 7;

Voxel cell_of(const std::int32_t end[3]) {
  return {(end[0] >> kFractionBits) - kReach, (end[1] >> kFractionBits) - kReach,
          (end[2] >> kFractionBits) - kReach};
}

}  // namespace

RayScratch::RayScratch(const RayRules& rules, Instructions instructions)
    : rules_(rules), instructions_(instructions) {
  passed_.begin(0, 0);
  hit_.begin(0, 0);
}

bool RayScratch::mark(const Pose3& T_map_base, const Cloud& cloud_base, const Stopped& stopped) {
  reach_m_ = std::numeric_limits<double>::infinity();
  collect(T_map_base, cloud_base);
  far_hits_.clear();
  std::vector<FixedRay> without_end;
  if (!box_.is_about_all()) without_end = cut_to_box();
  mark_hits();
  rays_.insert(rays_.end(), without_end.begin(), without_end.end());
  return follow(stopped);
}

// Takes the points that count, and lays the box about them.
void RayScratch::collect(const Pose3& T_map_base, const Cloud& cloud_base) {
  constexpr std::int32_t kHighest = std::numeric_limits<std::int32_t>::max();
  const std::size_t size = cloud_base.points.size();
  rays_.resize(size);
  PointJob job{};
  job.points = size == 0 ? nullptr : cloud_base.points[0].data();
  job.origins = cloud_base.origins.empty() ? nullptr : cloud_base.origins[0].data();
  job.size = size;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 4; ++k) job.matrix[i][k] = T_map_base(i, k) / rules_.resolution_m;
    job.matrix[i][3] += kReach;
    job.lowest[i] = kHighest;
  }
  job.min_range_m = static_cast<float>(rules_.min_range_m);
  job.max_range_m = static_cast<float>(rules_.max_range_m);
  job.rays = rays_.data();
  rays_.resize(take_points(job, instructions_));
  box_ = rays_.empty() ? RayBox() : RayBox(job.lowest, job.highest, rays_[0].from);
}

// Rays that start outside of the box are not followed, those that end outside are cut.
std::vector<FixedRay> RayScratch::cut_to_box() {
  const double fraction_m = std::ldexp(rules_.resolution_m, -kFractionBits);
  std::vector<FixedRay> inside, cut;
  std::vector<Voxel> far;
  for (FixedRay ray : rays_) {
    const bool starts_inside = box_.holds(ray.from), ends_inside = box_.holds(ray.to);
    if (!ends_inside) far.push_back(cell_of(ray.to));
    const double length = length_of(ray);
    double share = 1.0;
    if (!starts_inside) {
      share = 0.0;
      std::copy(ray.to, ray.to + 3, ray.from);
    } else if (!ends_inside) {
      share = box_.cut(ray);
    }
    if (share < 1.0) reach_m_ = std::min(reach_m_, share * length * fraction_m);
    if (ends_inside) inside.push_back(ray);
    if (!ends_inside && starts_inside) cut.push_back(ray);
  }
  rays_ = std::move(inside);
  keep_far_hits(std::move(far));
  for (FixedRay& ray : cut) {
    for (int i = 0; i < 3; ++i) {
      ray.from[i] -= box_.corner(i);
      ray.to[i] -= box_.corner(i);
    }
  }
  return cut;
}

void RayScratch::keep_far_hits(std::vector<Voxel> cells) {
  const auto before = [](const Voxel& a, const Voxel& b) { return block_of(a) < block_of(b); };
  std::sort(cells.begin(), cells.end(), before);
  far_hits_.clear();
  for (const Voxel& cell : cells) {
    if (far_hits_.empty() || far_hits_.back().block != block_of(cell))
      far_hits_.push_back({block_of(cell), {}});
    const std::size_t bit = bit_in_block(cell);
    far_hits_.back().hit[bit / 64] |= std::uint64_t{1} << bit % 64;
  }
}

bool RayScratch::starts_in_one_cell() const {
  return std::all_of(rays_.begin(), rays_.end(), [&](const FixedRay& ray) {
    return cell_of(ray.from) == cell_of(rays_.front().from);
  });
}

// Marks the ends of rays, and moves these into the box.
void RayScratch::mark_hits() {
  hit_.begin(box_.block_bits(), rays_.size());
  const int* shift = box_.block_shift();
  const bool first_alone = !rules_.every_ray && starts_in_one_cell();
  rays_.resize(mark_ends({rays_.data(),
                          rays_.size(),
                          {box_.corner(0), box_.corner(1), box_.corner(2)},
                          {shift[0], shift[1], shift[2]},
                          first_alone,
                          &hit_.bits()},
                         instructions_));
}

bool RayScratch::follow(const Stopped& stopped) {
  double longest = 0.0;
  if (!follow_to(std::numeric_limits<double>::infinity(), stopped)) return false;
  if (!passed_.bits().is_full) return true;
  for (const FixedRay& ray : rays_) longest = std::max(longest, length_of(ray));
  return follow_as_far_as_fits(longest, stopped);
}

// All rays equally far, so that none is favoured.
bool RayScratch::follow_as_far_as_fits(double longest, const Stopped& stopped) {
  double fits = 0.0, step = longest;
  for (int i = 0; i < kReachSteps; ++i) {
    step /= 2.0;
    if (!follow_to(fits + step, stopped)) return false;
    if (!passed_.bits().is_full) fits += step;
  }
  reach_m_ = std::min(reach_m_, std::ldexp(fits * rules_.resolution_m, -kFractionBits));
  return follow_to(fits, stopped);
}

bool RayScratch::follow_to(double length, const Stopped& stopped) {
  passed_.begin(box_.block_bits(), rules_.most_blocks);
  std::array<FixedRay, kRaysAtOnce> rays;
  const double end_gap = std::ldexp(rules_.end_gap_m / rules_.resolution_m, kFractionBits);
  for (std::size_t first = 0; first < rays_.size() && !passed_.bits().is_full;) {
    if (stopped && stopped()) return false;
    const std::size_t size = std::min(kRaysAtOnce, rays_.size() - first);
    const FixedRay* from = &rays_[first];
    if (!std::isinf(length) || end_gap > 0.0) {
      for (std::size_t i = 0; i < size; ++i) {
        const double whole = length_of(from[i]), wanted = std::min(length, whole - end_gap);
        rays[i] = part_of(from[i], whole > 0.0 ? std::clamp(wanted / whole, 0.0, 1.0) : 0.0);
      }
      from = rays.data();
    }
    const int* shift = box_.block_shift();
    mark_rays({from, size, {shift[0], shift[1], shift[2]}, &passed_.bits()}, instructions_);
    first += size;
  }
  return true;
}

std::size_t RayScratch::used_bytes() const { return passed_.used_bytes() + hit_.used_bytes(); }

}  // namespace voxlist
