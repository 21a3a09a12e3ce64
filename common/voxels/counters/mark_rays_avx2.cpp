// This file is compiled for its instruction set, and called only where the processor has that.
#include "voxlist/voxels/counters/point_job.h"
#include "voxlist/voxels/counters/ray_kernel.h"

namespace voxlist {

std::size_t take_points_avx2(PointJob& job);
std::size_t mark_ends_avx2(const EndJob& job);
void mark_rays_avx2(const RayJob& job);

std::size_t take_points_avx2(PointJob& job) { return take_points(job); }

std::size_t mark_ends_avx2(const EndJob& job) { return mark_ends(job); }

void mark_rays_avx2(const RayJob& job) {
  using Doubles = double __attribute__((vector_size(32)));
  using Integers = std::int64_t __attribute__((vector_size(32)));
  mark_rays_wide<Doubles, Integers>(job);
}

}  // namespace voxlist
