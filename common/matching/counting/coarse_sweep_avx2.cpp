// This file is compiled for its instruction set, and called only where the processor has that.
#include "voxlist/matching/counting/coarse_sweep_kernel.h"

namespace voxlist::matching {

void coarse_sweep_avx2(const SweepJob& job);

void coarse_sweep_avx2(const SweepJob& job) {
  using Word = std::uint64_t __attribute__((vector_size(32)));
  sweep<Word>(job);
}

}  // namespace voxlist::matching
