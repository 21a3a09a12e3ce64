#include "services/grid_export/scan_output.h"

#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pointcloud_t.hpp>

#include "voxlist/bus/bus.h"

namespace voxlist::services {
ScanOutput::ScanOutput(bus::Bus& bus, bus::Health& health,
                       const std::vector<planning::RobotProfile>& robots)
    : bus_(bus), input_(health, service::CloudInput::Sees::kTheNewest) {
  for (const planning::RobotProfile& robot : robots)
    outputs_.push_back({planning::band_of(robot), bus::kScanPrefix + robot.name,
                        bus::kScanFarPrefix + robot.name});
  bus_.subscribe(
      bus::kCloud, [this](const pointcloud_t& m) { take(m); }, bus::Delivery::kLatest);
}

void ScanOutput::take(const pointcloud_t& message) {
  const std::optional<Cloud> cloud = input_.take(message);
  if (!cloud) return;
  for (const Output& output : outputs_) {
    const planning::VirtualScan scan = planning::virtual_scan(*cloud, output.band);
    send(output.nearest, scan, scan.nearest_m);
    send(output.furthest, scan, scan.furthest_m);
  }
}

void ScanOutput::send(const std::string& channel, const planning::VirtualScan& scan,
                      const std::vector<float>& ranges_m) {
  planar_lidar_t message{};
  message.utime = scan.utime_us;
  message.radstep = static_cast<float>(scan.step_rad);
  message.nranges = static_cast<std::int32_t>(ranges_m.size());
  message.ranges = ranges_m;
  bus_.publish(bus::Channel<planar_lidar_t>{channel.c_str()}, message);
}

}  // namespace voxlist::services
