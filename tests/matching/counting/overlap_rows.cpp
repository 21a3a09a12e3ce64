#include "tests/matching/counting/overlap_rows.h"

#include <algorithm>
#include <array>
#include <bit>
#include <stdexcept>

#include "voxlist/matching/counting/coarse_sweep_kernel.h"

namespace voxlist::matching {

void coarse_sweep_avx2(const SweepJob& job);
void coarse_sweep_avx512(const SweepJob& job);

namespace {

constexpr std::size_t kVectorWords = 8;  // of the widest
constexpr std::size_t kSumPlanes = 16;   // of counts
constexpr std::size_t kMostCells =
    ((std::size_t{1} << kSweepPlanes) - 1) / kSweptAtOnce * kSweptAtOnce;

bool within(const Voxel& v, const Voxel& low, const Voxel& high) {
  return v.x >= low.x && v.x <= high.x && v.y >= low.y && v.y <= high.y && v.z >= low.z &&
         v.z <= high.z;
}

void check(const RowMap& map, std::span<const Voxel> scan, const TranslationBlock& block,
           std::size_t counts) {
  const auto [t, columns, rows] = block;
  if (columns < 0 || rows < 0 ||
      counts != static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))
    throw std::invalid_argument("overlap_rows: a block of another size than its counts");
  if (scan.size() > 65'535) throw std::invalid_argument("overlap_rows: too many voxels");
  for (const Voxel& v : scan) {
    const Voxel first{v.x + t.x, v.y + t.y, v.z + t.z};
    const Voxel last{first.x + columns - 1, first.y + rows - 1, first.z};
    if (!within(first, map.low(), map.high()) || !within(last, map.low(), map.high()))
      throw std::invalid_argument("overlap_rows: a voxel leaves the map's box");
  }
}

void run(const SweepJob& job, Instructions instructions) {
  switch (instructions) {
    case Instructions::kPortable:
      return sweep<std::uint64_t>(job);
    case Instructions::kAvx2:
      return coarse_sweep_avx2(job);
    case Instructions::kAvx512:
      return coarse_sweep_avx512(job);
  }
}

// Adds the kernel's counts to sums, both in bit planes of `words` words.
void add_planes(const std::vector<std::uint64_t>& planes, std::size_t words,
                std::vector<std::uint64_t>& sums) {
  for (std::size_t word = 0; word < words; ++word) {
    std::uint64_t carry = 0;
    for (std::size_t p = 0; p < kSumPlanes; ++p) {
      const std::uint64_t a = p < kSweepPlanes ? planes[p * words + word] : 0;
      std::uint64_t& sum = sums[p * words + word];
      const std::uint64_t either = sum ^ a, next = (sum & a) | (either & carry);
      sum = either ^ carry;
      carry = next;
    }
  }
}

using Lanes = std::array<std::uint16_t, 8>;

// Each byte's bits as eight numbers.
constexpr std::array<Lanes, 256> kBits = [] {
  std::array<Lanes, 256> table{};
  for (std::size_t byte = 0; byte < 256; ++byte)
    for (std::size_t i = 0; i < 8; ++i) table[byte][i] = static_cast<std::uint16_t>(byte >> i & 1);
  return table;
}();

// Bit planes as numbers.
void unpack(const std::vector<std::uint64_t>& sums, std::size_t words, std::size_t planes,
            std::span<std::uint16_t> counts) {
  for (std::size_t begin = 0; begin < counts.size(); begin += 8) {
    Lanes count{};
    for (std::size_t p = 0; p < planes; ++p) {
      const Lanes& bits = kBits[sums[p * words + begin / 64] >> begin % 64 & 255];
      for (std::size_t i = 0; i < 8; ++i)
        count[i] = static_cast<std::uint16_t>(count[i] | bits[i] << p);
    }
    const std::size_t size = std::min<std::size_t>(8, counts.size() - begin);
    std::copy_n(count.begin(), size, counts.begin() + static_cast<std::ptrdiff_t>(begin));
  }
}

}  // namespace

RowMap::RowMap(const VoxelMap& map, const Voxel& low, const Voxel& high)
    : low_(low),
      high_(high),
      row_words_((std::int64_t{high.x} - low.x) / 64 + 1),
      layer_words_((std::int64_t{high.y} - low.y + 1) * row_words_) {
  const std::int64_t layers = std::int64_t{high.z} - low.z + 1;
  words_.resize(static_cast<std::size_t>((layers + 1) * layer_words_) + 3 * kVectorWords);
  map.for_each_voxel([&](const Voxel& v) {
    if (!within(v, low_, high_)) return;
    const auto at = static_cast<std::size_t>(bit(v));
    words_[at / 64] |= std::uint64_t{1} << at % 64;
  });
}

void overlap_rows(const RowMap& map, std::span<const Voxel> scan, const TranslationBlock& block,
                  Instructions instructions, std::span<std::uint16_t> counts) {
  check(map, scan, block, counts.size());
  std::vector<std::int64_t> bits;
  for (const Voxel& v : scan)
    bits.push_back(map.bit({v.x + block.first.x, v.y + block.first.y, v.z + block.first.z}));
  bits.resize((bits.size() + kSweptAtOnce - 1) / kSweptAtOnce * kSweptAtOnce, map.free_bit());

  const auto columns = static_cast<std::size_t>(block.columns);
  constexpr std::size_t kVectorBits = 64 * kVectorWords;
  const std::size_t words = (columns + kVectorBits - 1) / kVectorBits * kVectorWords;
  const auto sum_planes = static_cast<std::size_t>(std::bit_width(scan.size()));
  std::vector<std::uint64_t> planes(kSweepPlanes * words), sums(kSumPlanes * words);
  for (std::int64_t row = 0; row < block.rows; ++row) {
    SweepJob job{map.words() + row * map.row_words(), words, nullptr, 0, planes.data()};
    std::fill(sums.begin(), sums.end(), 0);
    for (std::size_t begin = 0; begin < bits.size(); begin += kMostCells) {
      job.bits = bits.data() + begin;
      job.size = std::min(kMostCells, bits.size() - begin);
      run(job, instructions);
      add_planes(planes, words, sums);
    }
    unpack(sums, words, sum_planes,
           counts.subspan(static_cast<std::size_t>(row) * columns, columns));
  }
}

}  // namespace voxlist::matching
