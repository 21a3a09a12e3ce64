#include "services/grid_export/grid_output.h"

#include "voxlist/bus/bus.h"

namespace voxlist::services {

GridOutput::GridOutput(bus::Bus& bus, const std::vector<planning::RobotProfile>& robots,
                       std::int64_t repeat_period_us)
    : bus_(bus), repeat_period_us_(repeat_period_us) {
  for (const planning::RobotProfile& robot : robots) {
    Output& output = outputs_.emplace_back();
    output.name = robot.name;
    output.grid_channel = bus::kGridPrefix + robot.name;
    output.traversability_channel = bus::kTraversabilityPrefix + robot.name;
  }
}

void GridOutput::send(const std::vector<planning::TypedGrid>& grids, const GridSource& source,
                      std::int64_t now_us) {
  if (grids.empty()) return forget();
  for (std::size_t i = 0; i < grids.size(); ++i) {
    Output& output = outputs_[i];
    output.grid = to_pixel_map(grids[i], source, output.grid_zlib);
    output.traversability =
        to_traversability(grids[i], source, output.name, output.traversability_zlib);
  }
  publish(now_us);
}

void GridOutput::tick(std::int64_t now_us) {
  if (repeat_period_us_ == 0 || !sent_us_) return;
  const bool was_set_back = now_us < *sent_us_;
  if (was_set_back || now_us - *sent_us_ >= repeat_period_us_) publish(now_us);
}

void GridOutput::publish(std::int64_t now_us) {
  for (const Output& output : outputs_) {
    bus_.publish(bus::Channel<pixel_map_t>{output.grid_channel.c_str()}, output.grid,
                 bus::Delivery::kLatest);
    bus_.publish(bus::Channel<traversability_t>{output.traversability_channel.c_str()},
                 output.traversability, bus::Delivery::kLatest);
  }
  sent_us_ = now_us;
}

}  // namespace voxlist::services
