#include "voxlist/foreign/foxglove/space_points.h"

#include <algorithm>
#include <array>

#include "voxlist/bus/maps/map_convert.h"
#include "voxlist/foreign/foxglove/scene_messages.h"
#include "voxlist/voxels/halved.h"

namespace voxlist::foreign {
namespace {

using Type = PackedField::Type;

// Red, green, blue, alpha, occupied.
constexpr std::array<std::uint8_t, 5> kFree{60, 190, 120, 60, 0}, kOccupied{90, 90, 100, 255, 1};

void pack_cell(const Eigen::Vector3d& at, const std::array<std::uint8_t, 5>& rest, Packed& to) {
  pack(at, to);
  for (const std::uint8_t part : rest) pack(part, to);
}

}  // namespace

std::size_t SpacePoints::apply(const bus::MapChange& change) {
  utime_us_ = change.utime_us;
  const bus::AppliedChange applied = bus::apply(change, cells_);
  if (applied.replaced) return std::max<std::size_t>(blocks(), 1);
  return applied.changed.passed.size() + applied.changed.occupied.size();
}

Packed SpacePoints::points() const {
  Packed points{point_fields(), {}};
  for (const char* name : {"red", "green", "blue", "alpha", "occupied"})
    points.fields.push_back({name, Type::kUint8});
  const VoxelMap occupied = halved(cells_.occupied), free = halved(cells_.passed);
  const double edge_m = free.resolution_m();
  occupied.for_each_voxel([&](const Voxel& v) { pack_cell(center(v, edge_m), kOccupied, points); });
  free.for_each_voxel([&](const Voxel& v) {
    if (!occupied.contains(v)) pack_cell(center(v, edge_m), kFree, points);
  });
  return points;
}

}  // namespace voxlist::foreign
