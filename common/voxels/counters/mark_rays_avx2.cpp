// This file is compiled for its instruction set, and called only where the processor has that.
#include "voxlist/voxels/counters/ray_kernel.h"

namespace voxlist {

void mark_rays_avx2(const RayJob& job);

void mark_rays_avx2(const RayJob& job) {
  using Doubles = double __attribute__((vector_size(32)));
  using Integers = std::int64_t __attribute__((vector_size(32)));
  mark_rays_wide<Doubles, Integers>(job);
}

}  // namespace voxlist
