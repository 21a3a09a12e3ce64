#pragma once

#include <cstddef>
#include <cstdint>

#include "voxlist/voxels/counters/cell_bits.h"

namespace voxlist {

/// Fractions of a cell in which ends of rays are told: 2^-15, a third of a hundredth of a
/// millimetre at 0.1 m. More, and what is compared would not fit into a double.
inline constexpr int kFractionBits = 15;

/// Cells along each side of a box at most.
inline constexpr int kBoxBits = 13;

/// A ray in a box: x, y, z of its ends, in 2^-kFractionBits of a cell from the box's corner.
struct FixedRay {
  std::int32_t from[3], to[3];
};

/// Rays whose cells are to be marked, both ends included. `block_shift`: where the number of the
/// block along x, y and z goes in a key.
struct RayJob {
  const FixedRay* rays;
  std::size_t size;
  int block_shift[3];
  CellBits* cells;
};

namespace {

/// A ray seen along the axis on which it goes farthest, upwards: it crosses slab after slab of
/// cells along u, and in each at most one face along v and one along w. All is told in integers, so
/// the cells are exactly those of Amanatides and Woo between the ends. At the j-th face of u that
/// it crosses, v is (v_face + j v_step) / length cells, and w likewise; where that is on a face, it
/// is in the upper cell. Where faces of v and w are crossed at one time, that of w is first.
struct Slabs {
  int u, v, w;                  // axes
  std::int64_t length;          // of the ray along u, in fractions
  std::int64_t v_step, w_step;  // likewise
  std::int64_t v_face, w_face;
  std::int32_t first[3], last[3];  // cells, along x, y, z
  std::int32_t size;               // slabs
};

inline std::int32_t magnitude(std::int32_t value) { return value < 0 ? -value : value; }

/// Rays longer than this (2047 cells) are told in 2^-10 of a cell: products of two lengths stay
/// below 2^53.
inline constexpr std::int32_t kFineLength = 1 << 26;

inline Slabs slabs_of(const FixedRay& ray) {
  const std::int32_t way[3] = {ray.to[0] - ray.from[0], ray.to[1] - ray.from[1],
                               ray.to[2] - ray.from[2]};
  const std::int32_t x = magnitude(way[0]), y = magnitude(way[1]), z = magnitude(way[2]);
  Slabs s;
  s.u = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
  s.v = s.u == 0 ? 1 : 0;
  s.w = s.u == 2 ? 1 : 2;
  const bool turned = way[s.u] < 0;
  const std::int32_t* from = turned ? ray.to : ray.from;
  const std::int32_t* to = turned ? ray.from : ray.to;
  const int coarser = magnitude(way[s.u]) < kFineLength ? 0 : 5, bits = kFractionBits - coarser;
  for (int axis = 0; axis < 3; ++axis) {
    s.first[axis] = from[axis] >> kFractionBits;
    s.last[axis] = to[axis] >> kFractionBits;
  }
  const std::int64_t u0 = from[s.u] >> coarser, v0 = from[s.v] >> coarser,
                     w0 = from[s.w] >> coarser;
  s.length = (to[s.u] >> coarser) - u0;
  s.v_step = (to[s.v] >> coarser) - v0;
  s.w_step = (to[s.w] >> coarser) - w0;
  s.size = s.last[s.u] - s.first[s.u] + 1;
  const std::int64_t to_face = (std::int64_t{s.first[s.u] + 1} << bits) - u0;
  s.v_face = (v0 * s.length + s.v_step * to_face) >> bits;
  s.w_face = (w0 * s.length + s.w_step * to_face) >> bits;
  return s;
}

}  // namespace
}  // namespace voxlist
