#pragma once

#include <string>
#include <vector>

#include "voxlist/planning/profiles/robot_profile.h"
#include "voxlist/planning/virtual_scan/virtual_scan.h"
#include "voxlist/service/inputs/cloud_input.h"

namespace voxlist::bus {
class Bus;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// Turns each CLOUD into a 2D scan for each robot: SCAN_NAME (nearest) and SCAN_FAR_NAME
/// (furthest). Needs no map.
class ScanOutput {
 public:
  ScanOutput(bus::Bus& bus, bus::Health& health, const std::vector<planning::RobotProfile>& robots);

  void tick(std::int64_t now_us) { input_.tick(now_us); }

 private:
  struct Output {
    planning::ScanBand band;
    std::string nearest, furthest;  // channels
  };

  void take(const pointcloud_t& message);
  void send(const std::string& channel, const planning::VirtualScan& scan,
            const std::vector<float>& ranges_m);

  bus::Bus& bus_;
  service::CloudInput input_;
  std::vector<Output> outputs_;
};

}  // namespace voxlist::services
