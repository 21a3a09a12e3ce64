#pragma once
// As cell_bits.h: plain data and loops for files that are compiled for one instruction set each.

#include <cstddef>
#include <cstdint>

#include "voxlist/voxels/counters/ray_job.h"

namespace voxlist {

/// Cells from the map's origin along each axis that rays may reach: 655 m at 0.02 m. As many as an
/// OctoMap has.
inline constexpr std::int32_t kReach = 1 << 15;

/// Points of a scan that are to become rays, told in fractions of a cell from (-kReach, -kReach,
/// -kReach) on.
struct PointJob {
  const float* points;   ///< x, y, z of each
  const float* origins;  ///< likewise; nullptr: (0, 0, 0)
  std::size_t size;
  double matrix[3][4];  ///< from the scan to the map, in cells
  float min_range_m, max_range_m;
  FixedRay* rays;                      ///< room for all
  std::int32_t lowest[3], highest[3];  ///< of ends and starts, to be widened
};

/// Rays whose ends are to be marked and which are to be moved: by -corner.
struct EndJob {
  FixedRay* rays;
  std::size_t size;
  std::int32_t corner[3];
  int block_shift[3];
  bool first_alone;  ///< only the first of those with one end is kept
  CellBits* cells;
};

namespace {

inline constexpr std::size_t kPointsAtOnce = 64;

// One axis of points in the map, in fractions of a cell; false where a point is outside.
struct Coordinates {
  alignas(64) std::int32_t at[3][kPointsAtOnce];
};

struct Points {
  alignas(64) float at[3][kPointsAtOnce];
};

inline void load(const float* from, std::size_t size, Points& out) {
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) out.at[axis][i] = from[3 * i + axis];
}

inline void place(const PointJob& job, const Points& in, std::int32_t* good, Coordinates& out) {
  constexpr double kOne = std::int32_t{1} << kFractionBits, kEnd = 2.0 * kReach * kOne;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double* m = job.matrix[axis];
    for (std::size_t i = 0; i < kPointsAtOnce; ++i) {
      const double value =
          (m[0] * in.at[0][i] + m[1] * in.at[1][i] + m[2] * in.at[2][i] + m[3]) * kOne;
      const bool is_inside = value >= 0.0 && value < kEnd;
      good[i] &= is_inside ? -1 : 0;
      out.at[axis][i] = static_cast<std::int32_t>(is_inside ? value : 0.0);
    }
  }
}

inline float square(float value) { return value * value; }

// Which points are hits, as is_within() says, by the squares of their ranges.
inline void judge(const PointJob& job, const Points& from, const Points& to, std::int32_t* good) {
  const float least = square(job.min_range_m), most = square(job.max_range_m);
  for (std::size_t i = 0; i < kPointsAtOnce; ++i) {
    const float range = square(to.at[0][i] - from.at[0][i]) + square(to.at[1][i] - from.at[1][i]) +
                        square(to.at[2][i] - from.at[2][i]);
    const float size = square(to.at[0][i]) + square(to.at[1][i]) + square(to.at[2][i]);
    const std::int32_t is_point = size > 0.0F ? -1 : 0, is_ray = range > 0.0F ? -1 : 0;
    const std::int32_t is_far = range >= least ? -1 : 0, is_near = range <= most ? -1 : 0;
    good[i] = is_point & is_ray & is_far & is_near;
  }
}

inline void widen(PointJob& job, const Coordinates& ends, const std::int32_t* good) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::int32_t lowest = job.lowest[axis], highest = job.highest[axis];
    for (std::size_t i = 0; i < kPointsAtOnce; ++i) {
      const std::int32_t low = good[i] != 0 ? ends.at[axis][i] : lowest;
      const std::int32_t high = good[i] != 0 ? ends.at[axis][i] : highest;
      lowest = low < lowest ? low : lowest;
      highest = high > highest ? high : highest;
    }
    job.lowest[axis] = lowest;
    job.highest[axis] = highest;
  }
}

inline std::size_t put(const Coordinates& from, const Coordinates& to, const std::int32_t* good,
                       std::size_t size, FixedRay* rays) {
  std::size_t taken = 0;
  for (std::size_t i = 0; i < size; ++i) {
    rays[taken] = {{from.at[0][i], from.at[1][i], from.at[2][i]},
                   {to.at[0][i], to.at[1][i], to.at[2][i]}};
    taken += good[i] != 0;
  }
  return taken;
}

// The starts of the rays in the map. Most scans have one for all, which is placed once.
class Starts {
 public:
  explicit Starts(PointJob& job) : job_(job) { place_all(); }

  void take(std::size_t first, std::size_t size) {
    const float* next = job_.origins == nullptr ? nullptr : job_.origins + 3 * first;
    if (next == nullptr || is_as_before(next, size)) return;
    before_ = next;
    load(next, size, origins);
    for (std::size_t i = size; i < kPointsAtOnce; ++i)
      for (auto& axis : origins.at) axis[i] = axis[0];
    place_all();
  }

  Points origins{};
  Coordinates at;
  alignas(64) std::int32_t good[kPointsAtOnce];

 private:
  bool is_as_before(const float* next, std::size_t size) const {
    return before_ != nullptr && __builtin_memcmp(next, before_, 3 * size * sizeof(float)) == 0;
  }

  void place_all() {
    for (std::int32_t& g : good) g = -1;
    place(job_, origins, good, at);
    if (job_.origins == nullptr || before_ != nullptr) widen(job_, at, good);
  }

  PointJob& job_;
  const float* before_ = nullptr;
};

// Returns how many rays there are.
inline std::size_t take_points(PointJob& job) {
  alignas(64) std::int32_t good[kPointsAtOnce];
  Starts starts(job);
  Points points{};
  Coordinates ends;
  std::size_t taken = 0;
  for (std::size_t first = 0; first < job.size; first += kPointsAtOnce) {
    const std::size_t left = job.size - first;
    const std::size_t size = left < kPointsAtOnce ? left : kPointsAtOnce;
    load(job.points + 3 * first, size, points);
    starts.take(first, size);
    judge(job, starts.origins, points, good);
    for (std::size_t i = 0; i < kPointsAtOnce; ++i) good[i] &= i < size ? starts.good[i] : 0;
    place(job, points, good, ends);
    widen(job, ends, good);
    taken += put(starts.at, ends, good, size, job.rays + taken);
  }
  return taken;
}

// Returns how many rays are kept.
inline std::size_t mark_ends(const EndJob& job) {
  alignas(64) std::uint64_t keys[kPointsAtOnce];
  std::size_t kept = 0;
  for (std::size_t first = 0; first < job.size; first += kPointsAtOnce) {
    const std::size_t left = job.size - first;
    const std::size_t size = left < kPointsAtOnce ? left : kPointsAtOnce;
    FixedRay* rays = job.rays + first;
    for (std::size_t i = 0; i < size; ++i) {
      keys[i] = 0;
      for (int axis = 0; axis < 3; ++axis) {
        rays[i].from[axis] -= job.corner[axis];
        rays[i].to[axis] -= job.corner[axis];
        const auto cell = static_cast<std::uint64_t>(rays[i].to[axis] >> kFractionBits);
        keys[i] |= key_part(cell, axis, job.block_shift[axis]);
      }
    }
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint64_t bit = std::uint64_t{1} << (keys[i] & 63);
      std::uint64_t& word = word_at(*job.cells, keys[i] >> 6);
      job.rays[kept] = rays[i];
      kept += !job.first_alone || (word & bit) == 0;
      word |= bit;
    }
  }
  return kept;
}

}  // namespace
}  // namespace voxlist
