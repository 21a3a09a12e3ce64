#include "services/voxlist/commands/views/distance_field.h"

#include <dynamicEDT3D/dynamicEDT3D.h>
#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace voxlist::desk {
namespace {

constexpr double kCell_m = kPassedResolution_m;
constexpr std::int32_t kVoxelsInCell = 4;

std::array<std::int32_t, 3> sizes(const VoxelBox& box) {
  return {box.highest.x - box.lowest.x + 1, box.highest.y - box.lowest.y + 1,
          box.highest.z - box.lowest.z + 1};
}

std::size_t cells_in(const VoxelBox& box) {
  const auto [x, y, z] = sizes(box);
  return static_cast<std::size_t>(x) * static_cast<std::size_t>(y) * static_cast<std::size_t>(z);
}

VoxelBox grown(const VoxelBox& box, std::int32_t by) {
  return {{box.lowest.x - by, box.lowest.y - by, box.lowest.z - by},
          {box.highest.x + by, box.highest.y + by, box.highest.z + by}};
}

bool contains(const VoxelBox& box, const Voxel& v) {
  return v.x >= box.lowest.x && v.x <= box.highest.x && v.y >= box.lowest.y &&
         v.y <= box.highest.y && v.z >= box.lowest.z && v.z <= box.highest.z;
}

// Cells of a box, one byte each: 1 where it is free.
class FreeCells {
 public:
  FreeCells(const OccupancyMap& map, const OccupancyMap& free_space, const VoxelBox& box)
      : box_(box), cells_(cells_in(box), 0) {
    free_space.passed.for_each_voxel([&](const Voxel& v) { set(v, 1); });
    free_space.occupied.for_each_voxel([&](const Voxel& v) { set(v, 0); });
    map.occupied.for_each_voxel([&](const Voxel& v) {
      set({floor_div(v.x, kVoxelsInCell), floor_div(v.y, kVoxelsInCell),
           floor_div(v.z, kVoxelsInCell)},
          0);
    });
  }

  bool at(const Voxel& v) const { return contains(box_, v) && cells_[index(v)] != 0; }

  // A cell that is not free beside one that is: the only ones from which distances count.
  bool is_face(const Voxel& v) const {
    if (at(v)) return false;
    for (std::int32_t i = 0; i < 27; ++i)
      if (at({v.x + i % 3 - 1, v.y + i / 3 % 3 - 1, v.z + i / 9 - 1})) return true;
    return false;
  }

 private:
  void set(const Voxel& v, char value) {
    if (contains(box_, v)) cells_[index(v)] = value;
  }

  std::size_t index(const Voxel& v) const {
    const auto [nx, ny, nz] = sizes(box_);
    return (static_cast<std::size_t>(v.z - box_.lowest.z) * static_cast<std::size_t>(ny) +
            static_cast<std::size_t>(v.y - box_.lowest.y)) *
               static_cast<std::size_t>(nx) +
           static_cast<std::size_t>(v.x - box_.lowest.x);
  }

  const VoxelBox box_;
  std::vector<char> cells_;
};

template <class Visit>
void for_each_cell(const VoxelBox& box, const Visit& visit) {
  for (std::int32_t z = box.lowest.z; z <= box.highest.z; ++z)
    for (std::int32_t y = box.lowest.y; y <= box.highest.y; ++y)
      for (std::int32_t x = box.lowest.x; x <= box.highest.x; ++x) visit(Voxel{x, y, z});
}

void widen(const VoxelMap& cells, std::optional<VoxelBox>& box) {
  const auto bounds = cells.bounds();
  if (!bounds) return;
  if (!box) {
    box = bounds;
    return;
  }
  box->lowest = {std::min(box->lowest.x, bounds->lowest.x),
                 std::min(box->lowest.y, bounds->lowest.y),
                 std::min(box->lowest.z, bounds->lowest.z)};
  box->highest = {std::max(box->highest.x, bounds->highest.x),
                  std::max(box->highest.y, bounds->highest.y),
                  std::max(box->highest.z, bounds->highest.z)};
}

}  // namespace

std::size_t DistanceField::count(int axis) const {
  return static_cast<std::size_t>(sizes(box)[static_cast<std::size_t>(axis)]);
}

std::optional<VoxelBox> known_box(const OccupancyMap& free_space) {
  std::optional<VoxelBox> box;
  widen(free_space.passed, box);
  widen(free_space.occupied, box);
  return box;
}

DistanceField distance_field(const OccupancyMap& map, const OccupancyMap& free_space,
                             const VoxelBox& box, double most_m) {
  const auto most = static_cast<std::int32_t>(std::ceil(most_m / kCell_m));
  const VoxelBox about = grown(box, most);
  if (cells_in(about) > kMostFieldCells)
    throw std::length_error(fmt::format(
        "a distance field of {} cells is too large for one file: give --tiles", cells_in(about)));
  const FreeCells free(map, free_space, about);
  const auto [nx, ny, nz] = sizes(about);
  DynamicEDT3D transform(most * most);
  transform.initializeEmpty(nx, ny, nz);
  const auto local = [&](const Voxel& v) {
    return Voxel{v.x - about.lowest.x, v.y - about.lowest.y, v.z - about.lowest.z};
  };
  for_each_cell(about, [&](const Voxel& v) {
    if (free.is_face(v)) transform.occupyCell(local(v).x, local(v).y, local(v).z);
  });
  transform.update(true);
  DistanceField field{box, {}};
  field.far_m.reserve(cells_in(box));
  for_each_cell(box, [&](const Voxel& v) {
    const float cells =
        free.at(v) ? transform.getDistance(local(v).x, local(v).y, local(v).z) : 0.0F;
    field.far_m.push_back(static_cast<float>(std::min(cells * kCell_m, most_m)));
  });
  return field;
}

std::string npy(const DistanceField& field) {
  static_assert(std::endian::native == std::endian::little);
  std::string header =
      fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}, {}), }}",
                  field.count(2), field.count(1), field.count(0));
  // The data begins at a multiple of 64 bytes, and the header ends with a line.
  constexpr std::size_t kBefore = 10;
  while ((kBefore + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(header.size() & 0xFF);
  bytes += static_cast<char>(header.size() >> 8);
  bytes += header;
  const std::size_t begin = bytes.size();
  bytes.resize(begin + field.far_m.size() * sizeof(float));
  std::memcpy(bytes.data() + begin, field.far_m.data(), field.far_m.size() * sizeof(float));
  return bytes;
}

std::string place_yaml(const DistanceField& field, const std::string& npy_name, double most_m) {
  const Voxel& low = field.box.lowest;
  return fmt::format(
      "array: {}\nresolution: {:.9f}\norigin: [{:.9f}, {:.9f}, {:.9f}]\nmost: {:g}\n", npy_name,
      kCell_m, low.x * kCell_m, low.y * kCell_m, low.z * kCell_m, most_m);
}

}  // namespace voxlist::desk
