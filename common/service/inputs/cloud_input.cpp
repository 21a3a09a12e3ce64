#include "voxlist/service/inputs/cloud_input.h"

#include <voxlist/pointcloud_t.hpp>

#include "voxlist/bus/convert.h"
#include "voxlist/service/inputs/cloud_findings.h"

namespace voxlist::service {

CloudInput::CloudInput(bus::Health& health, Sees sees)
    : health_(health),
      sees_(sees),
      check_(health, {.channel = "CLOUD", .remedy = "is a scanner running?"}) {}

std::optional<Cloud> CloudInput::take(const pointcloud_t& message) {
  if (sees_ == Sees::kEveryMessage) check_.take_number(message.seq);
  if (!check_.take(message.utime)) return std::nullopt;
  auto received = bus::from_message(message);
  if (received.dropped_points > 0) health_.count("CLOUD/dropped_points", received.dropped_points);
  if (!received.cloud) {
    health_.count("CLOUD/" + received.refusal);
    return std::nullopt;
  }
  bool refused = false;
  for (const CloudFinding& finding :
       cloud_findings(message.frame_id, *received.cloud, received.dropped_points)) {
    check_.note(finding.key, bus::Health::State::kWarning, finding.sentence);
    if (finding.refuses) health_.count("CLOUD/" + finding.key);
    refused |= finding.refuses;
  }
  if (refused) return std::nullopt;
  return std::move(received.cloud);
}

}  // namespace voxlist::service
