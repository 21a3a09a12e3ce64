// This file is compiled for its instruction set, and called only where the processor has that.
#include "voxlist/matching/counting/window_count_kernel.h"

namespace voxlist::matching {

void window_turn_avx512(const TurnJob& job);
void window_count_avx512(const CountJob& job);

void window_turn_avx512(const TurnJob& job) { turn_points(job); }

void window_count_avx512(const CountJob& job) {
  using Row = std::uint64_t __attribute__((vector_size(32)));
  using Word = std::uint64_t __attribute__((vector_size(64)));
  count_group<Word, Row>(job);
}

}  // namespace voxlist::matching
