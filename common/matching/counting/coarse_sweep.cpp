#include "voxlist/matching/counting/coarse_sweep.h"

#include <string>

#include "voxlist/matching/counting/coarse_sweep_kernel.h"
#include "voxlist/system/check.h"

namespace voxlist::matching {

void coarse_sweep_avx2(const SweepJob& job);
void coarse_sweep_avx512(const SweepJob& job);

namespace {

std::size_t words_of(Instructions instructions) {
  return instructions == Instructions::kAvx512 ? 8 : instructions == Instructions::kAvx2 ? 4 : 1;
}

}  // namespace

NodeCounts coarse_sweep(const CoarseMap& map, std::vector<std::int64_t> bits,
                        Instructions instructions) {
  static_assert(kSweepPlanes == kCountPlanes);
  VOXLIST_CHECK(bits.size() < std::size_t{1} << kCountPlanes,
                std::to_string(bits.size()) + " cells overflow the counters");
  bits.resize((bits.size() + kSweptAtOnce - 1) / kSweptAtOnce * kSweptAtOnce, map.free_bit());
  const std::size_t vector_words = words_of(instructions);
  const auto nodes = static_cast<std::size_t>((map.size_y() - 1) * map.row_bits() + map.size_x());
  NodeCounts counts;
  counts.words = (nodes / (64 * vector_words) + 1) * vector_words;
  counts.planes.resize(kCountPlanes * counts.words);
  const SweepJob job{map.words(), counts.words, bits.data(), bits.size(), counts.planes.data()};
  switch (instructions) {
    case Instructions::kPortable:
      sweep<std::uint64_t>(job);
      break;
    case Instructions::kAvx2:
      coarse_sweep_avx2(job);
      break;
    case Instructions::kAvx512:
      coarse_sweep_avx512(job);
      break;
  }
  return counts;
}

}  // namespace voxlist::matching
