#include "tests/voxels/counters/exact_walk.h"

#include <algorithm>
#include <cstdlib>

namespace voxlist {
namespace {

__extension__ using Wide = __int128;

// When a ray crosses its next face along an axis: way to the face over the whole way.
struct Axis {
  std::int64_t from, way;
  std::int32_t cell, last;

  bool is_done() const { return cell == last; }

  Wide to_face() const {
    const std::int64_t face = (std::int64_t{cell} + (way > 0 ? 1 : 0)) << kFractionBits;
    return way > 0 ? face - from : from - face;
  }

  Wide length() const { return std::llabs(way); }

  void cross() { cell += way > 0 ? 1 : -1; }
};

Axis axis(const FixedRay& ray, int i) {
  return {ray.from[i], std::int64_t{ray.to[i]} - ray.from[i], ray.from[i] >> kFractionBits,
          ray.to[i] >> kFractionBits};
}

// Whether a's next face is met before b's. Where both are met at once `tie` decides.
bool is_before(const Axis& a, const Axis& b, bool tie) {
  if (a.is_done() || b.is_done()) return !a.is_done();
  const Wide left = a.to_face() * b.length(), right = b.to_face() * a.length();
  return left < right || (left == right && tie);
}

}  // namespace

std::set<Voxel> exact_walk(const FixedRay& given) {
  FixedRay ray = given;
  Axis axes[3] = {axis(ray, 0), axis(ray, 1), axis(ray, 2)};
  int u = 0;
  for (int i = 1; i < 3; ++i)
    if (axes[i].length() > axes[u].length()) u = i;
  if (axes[u].way < 0)
    for (int i = 0; i < 3; ++i) std::swap(ray.from[i], ray.to[i]);
  for (int i = 0; i < 3; ++i) axes[i] = axis(ray, i);
  Axis &a = axes[u], &v = axes[u == 0 ? 1 : 0], &w = axes[u == 2 ? 1 : 2];
  std::set<Voxel> cells;
  for (;;) {
    cells.insert({axes[0].cell, axes[1].cell, axes[2].cell});
    if (a.is_done() && v.is_done() && w.is_done()) return cells;
    // A place on a face is in the upper cell: upwards it is crossed with the slab before, downwards
    // with the slab after.
    const bool v_over_u = is_before(v, a, v.way > 0), w_over_u = is_before(w, a, w.way > 0);
    if (v_over_u && (!w_over_u || is_before(v, w, false)))
      v.cross();
    else if (w_over_u)
      w.cross();
    else
      a.cross();
  }
}

}  // namespace voxlist
