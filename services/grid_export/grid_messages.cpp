#include "services/grid_export/grid_messages.h"

#include <span>

#include "voxlist/planning/grids/grid_files.h"

namespace voxlist::services {
namespace {

template <class Message>
void set_place(const planning::CellBox& box, Message& message) {
  const Eigen::Vector2d corner = planning::corner_m(box);
  message.dimensions[0] = box.width();
  message.dimensions[1] = box.height();
  message.xy0[0] = corner.x();
  message.xy0[1] = corner.y();
  message.compressed = 1;
}

}  // namespace

pixel_map_t to_pixel_map(const planning::TypedGrid& grid, const GridSource& source,
                         BandedZlib& zlib) {
  pixel_map_t message{};
  message.utime = source.utime_us;
  set_place(grid.box, message);
  message.xy1[0] = message.xy0[0] + grid.box.width() * planning::kColumn_m;
  message.xy1[1] = message.xy0[1] + grid.box.height() * planning::kColumn_m;
  message.mpp = planning::kColumn_m;
  message.data_type = pixel_map_t::DATA_TYPE_UINT8;
  message.mapData = zlib.compress(planning::likelihoods(grid));
  message.datasize = static_cast<std::int32_t>(message.mapData.size());
  return message;
}

traversability_t to_traversability(const planning::TypedGrid& grid, const GridSource& source,
                                   const std::string& profile, BandedZlib& zlib) {
  traversability_t message{};
  message.utime = source.utime_us;
  message.map_id = source.map_id;
  message.version = source.version;
  message.profile = profile;
  message.resolution_m = planning::kColumn_m;
  set_place(grid.box, message);
  static_assert(sizeof(planning::CellType) == 1);
  message.cells =
      zlib.compress({reinterpret_cast<const std::uint8_t*>(grid.cells.data()), grid.cells.size()});
  message.datasize = static_cast<std::int32_t>(message.cells.size());
  return message;
}

}  // namespace voxlist::services
