#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/grid_export/grid_messages.h"
#include "voxlist/planning/profiles/robot_profile.h"

namespace voxlist::bus {
class Bus;
}  // namespace voxlist::bus

namespace voxlist::services {

/// Publishes GRID_NAME and TRAVERSABILITY_NAME for each robot, and repeats the last ones for who
/// starts later.
class GridOutput {
 public:
  /// `repeat_period_us`: so long after they were sent grids are sent again; 0: never.
  GridOutput(bus::Bus& bus, const std::vector<planning::RobotProfile>& robots,
             std::int64_t repeat_period_us);

  /// A grid for each robot, in their order; without any the last ones are forgotten.
  void send(const std::vector<planning::TypedGrid>& grids, const GridSource& source,
            std::int64_t now_us);

  /// Repeats the last grids when that is due.
  void tick(std::int64_t now_us);

  /// The last grids are of a map that is no more: they are not repeated.
  void forget() { sent_us_.reset(); }

 private:
  struct Output {
    std::string name, grid_channel, traversability_channel;
    BandedZlib grid_zlib, traversability_zlib;
    pixel_map_t grid;
    traversability_t traversability;
  };

  void publish(std::int64_t now_us);

  bus::Bus& bus_;
  const std::int64_t repeat_period_us_;
  std::vector<Output> outputs_;
  std::optional<std::int64_t> sent_us_;
};

}  // namespace voxlist::services
