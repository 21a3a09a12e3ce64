#include "services/mirror_monitor/mirror_monitor_config.h"

#include <stdexcept>

#include "services/mirror_monitor/open_edge_source.h"
#include "voxlist/geometry/angle.h"

namespace voxlist::services {
namespace {

// The least that an arm may block (degrees): ArmDetector leaves two beams at each end, and needs
// three that come or leave.
constexpr double kMinArm_deg = 8.0;

}  // namespace

scanner::MirrorClockConfig mirror_clock_config(const MirrorMonitorConfig& config) {
  const std::size_t arms = config.arm_angle_deg.size();
  if (arms < 1 || arms > 2) throw std::invalid_argument("arm_angle_deg must name one arm or two");
  if (config.arm_first_beam_deg.size() != arms || config.arm_last_beam_deg.size() != arms) {
    throw std::invalid_argument(
        "arm_first_beam_deg and arm_last_beam_deg must have as many values as arm_angle_deg");
  }
  scanner::MirrorClockConfig result;
  for (std::size_t i = 0; i < arms; ++i) {
    const double first_deg = config.arm_first_beam_deg[i], last_deg = config.arm_last_beam_deg[i];
    if (last_deg - first_deg < kMinArm_deg)
      throw std::invalid_argument(
          "an arm must block 8 deg of beams or more: see arm_last_beam_deg");
    result.arms.push_back(
        {config.arm_angle_deg[i] * kRadPerDeg, first_deg * kRadPerDeg, last_deg * kRadPerDeg});
  }
  result.arm_height_max_m = config.arm_height_max_m;
  result.steps_per_revolution = config.steps_per_revolution;
  result.has_clock = names_a_clock(config.clock);
  result.turns_backwards = config.turns_backwards;
  result.staircase = config.staircase;
  return result;
}

}  // namespace voxlist::services
