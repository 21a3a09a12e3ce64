#include "voxlist/planning/grids/grid_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "voxlist/drawing/picture.h"
#include "voxlist/io/files/atomic_file.h"

namespace voxlist::planning {
namespace {

io::Rgb colour_of(CellType type) {
  switch (type) {
    case CellType::kFree:
      return {255, 255, 255};
    case CellType::kObstacle:
      return {0, 0, 0};
    case CellType::kOverhang:
      return {230, 140, 30};
    case CellType::kNegative:
      return {40, 90, 220};
    case CellType::kUnknown:
      break;
  }
  return {128, 128, 128};
}

char shade_of(CellType type) {
  switch (drivable(type)) {
    case Drivable::kFree:
      return static_cast<char>(254);
    case Drivable::kBlocked:
      return 0;
    case Drivable::kUnknown:
      break;
  }
  return static_cast<char>(128);
}

// Calls visit(type) for each cell as images have them: from the top row on.
template <class Visit>
void for_each_pixel(const TypedGrid& grid, const Visit& visit) {
  for (std::int32_t y = grid.box.high.y; y-- > grid.box.low.y;)
    for (std::int32_t x = grid.box.low.x; x < grid.box.high.x; ++x) visit(grid.at({x, y}));
}

}  // namespace

Drivable drivable(CellType type) {
  if (type == CellType::kFree) return Drivable::kFree;
  return type == CellType::kUnknown ? Drivable::kUnknown : Drivable::kBlocked;
}

std::vector<std::uint8_t> likelihoods(const TypedGrid& grid) {
  std::vector<std::uint8_t> values;
  values.reserve(grid.cells.size());
  for (const CellType type : grid.cells) {
    const Drivable what = drivable(type);
    values.push_back(what == Drivable::kFree ? 0 : what == Drivable::kUnknown ? 127 : 255);
  }
  return values;
}

Eigen::Vector2d corner_m(const CellBox& box) {
  return Eigen::Vector2d(box.low.x, box.low.y) * kColumn_m;
}

std::string pgm(const TypedGrid& grid) {
  std::string bytes = fmt::format("P5\n{} {}\n255\n", grid.box.width(), grid.box.height());
  bytes.reserve(bytes.size() + grid.cells.size());
  for_each_pixel(grid, [&](CellType type) { bytes += shade_of(type); });
  return bytes;
}

std::string yaml(const CellBox& box, const std::string& pgm_name) {
  const Eigen::Vector2d corner = corner_m(box);
  return fmt::format(
      "image: {}\nmode: trinary\nresolution: {:.9f}\norigin: [{:.9f}, {:.9f}, 0.0]\nnegate: 0\n"
      "occupied_thresh: 0.65\nfree_thresh: 0.196\n",
      pgm_name, kColumn_m, corner.x(), corner.y());
}

drawing::Raster typed_raster(const TypedGrid& grid) {
  drawing::Raster raster(grid.box.width(), grid.box.height(), {});
  std::size_t pixel = 0;
  for_each_pixel(grid, [&](CellType type) { raster.pixels[pixel++] = colour_of(type); });
  return raster;
}

std::vector<GridTile> tiles_of(const CellBox& box, std::int32_t side) {
  if (box.width() <= side && box.height() <= side) return {{"", box}};
  std::vector<GridTile> tiles;
  for (std::int32_t y = box.low.y, j = 0; y < box.high.y; y += side, ++j)
    for (std::int32_t x = box.low.x, i = 0; x < box.high.x; x += side, ++i)
      tiles.push_back({fmt::format("_{}_{}", i, j),
                       {{x, y}, {std::min(x + side, box.high.x), std::min(y + side, box.high.y)}}});
  return tiles;
}

TypedGrid part_of(const TypedGrid& grid, const CellBox& box) {
  TypedGrid part{box, {}};
  part.cells.reserve(box.size());
  for (std::int32_t y = box.low.y; y < box.high.y; ++y)
    for (std::int32_t x = box.low.x; x < box.high.x; ++x) part.cells.push_back(grid.at({x, y}));
  return part;
}

void write_grid(const TypedGrid& grid, const std::filesystem::path& folder,
                const std::string& name) {
  if (std::max(grid.box.width(), grid.box.height()) > kLargestImage)
    throw std::length_error(fmt::format("a grid of {} x {} cells is too large for one image",
                                        grid.box.width(), grid.box.height()));
  io::write_file_atomically(folder / (name + ".pgm"), pgm(grid));
  io::write_file_atomically(folder / (name + ".yaml"), yaml(grid.box, name + ".pgm"));
  drawing::Picture picture(grid.box.width(), grid.box.height(), {});
  picture.paste(typed_raster(grid), 0, 0);
  picture.write_png(folder / (name + ".png"));
}

}  // namespace voxlist::planning
