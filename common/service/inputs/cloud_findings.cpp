#include "voxlist/service/inputs/cloud_findings.h"

#include <fmt/core.h>

#include <algorithm>

namespace voxlist::service {
namespace {

// Clouds with fewer points tell nothing of a place: the lens is covered, or nothing is in range.
constexpr std::size_t kFewPoints = 50;

// No laser measures half of its points beyond this (m); a room in millimetres is ten times as
// large.
constexpr float kFar_m = 500.0F;

// Points that are looked at for the extent.
constexpr std::size_t kSample = 1000;

float median_range_m(const std::vector<Eigen::Vector3f>& points) {
  std::vector<float> ranges_m;
  const std::size_t step = std::max<std::size_t>(1, points.size() / kSample);
  for (std::size_t i = 0; i < points.size(); i += step) ranges_m.push_back(points[i].norm());
  if (ranges_m.empty()) return 0.0F;
  const auto middle = ranges_m.begin() + static_cast<std::ptrdiff_t>(ranges_m.size() / 2);
  std::ranges::nth_element(ranges_m, middle);
  return *middle;
}

CloudFinding too_few(std::size_t points, std::int64_t dropped_points) {
  std::string sentence =
      fmt::format("CLOUD has only {} points: is the lens covered, or nothing in range?", points);
  if (dropped_points > 0)
    sentence = fmt::format(
        "CLOUD has only {} points, {} more are not finite or beyond 10 km: are they in metres?",
        points, dropped_points);
  return {"few_points", sentence};
}

}  // namespace

std::vector<CloudFinding> cloud_findings(const std::string& frame_id, const Cloud& cloud,
                                         std::int64_t dropped_points) {
  std::vector<CloudFinding> findings;
  if (frame_id != "base")
    findings.push_back(
        {"frame", fmt::format("CLOUD is in frame \"{}\", and is taken as if it were in base "
                              "(on the floor under the robot, x forward, z up)",
                              frame_id)});
  if (cloud.points.size() < kFewPoints)
    findings.push_back(too_few(cloud.points.size(), dropped_points));
  if (const float range_m = median_range_m(cloud.points); range_m > kFar_m)
    findings.push_back(
        {"too_far",
         fmt::format("half of CLOUD's points are {:.1f} km away or more: are they in millimetres?",
                     range_m / 1000.0F),
         true});
  return findings;
}

}  // namespace voxlist::service
