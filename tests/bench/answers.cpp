#include "tests/bench/answers.h"

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "tests/bench/drives/bad_scans.h"

namespace voxlist::bench {
namespace {

// A pose that is off by less is the right place.
constexpr double kRight_m = 0.15, kRight_rad = 1.5 * std::numbers::pi / 180.0;

bool right(const Pose2& pose, const Pose2& truth) {
  return distance_m(pose, truth) < kRight_m && turn_rad(pose, truth) < kRight_rad;
}

Cloud scan_of(const Kind& kind, const simulation::Building& building, const Pose2& truth,
              std::uint64_t noise) {
  return kind.dense ? sphere_scan_at(building, truth, 64'000, kind.people, noise)
                    : scan_at(building, truth, kind.people, noise);
}

}  // namespace

simulation::Building now(const Kind& kind, const TestFloorConfig& mapped) {
  if (kind.changed) return later(mapped);
  const TestFloorConfig there = kind.foreign ? elsewhere(mapped) : mapped;
  return make_floor(there.wing, there.wings);
}

Cloud as_seen(const Kind& kind, Cloud scan, simulation::Random& random) {
  return kind.short_returns > 0.0 ? with_short_returns(std::move(scan), kind.short_returns, random)
                                  : scan;
}

std::vector<Query> scans_about(const Kind& kind, const TestFloor& floor,
                               const simulation::Building& building, int count, int seed) {
  simulation::Random random(4711, static_cast<std::uint64_t>(seed)),
      noise(4712, static_cast<std::uint64_t>(seed));
  std::vector<Query> queries;
  while (std::ssize(queries) < count) {
    const Pose2 truth = free_pose(floor, random);
    if (building.clearance_m({truth.x_m, truth.y_m}, 0.05, 1.0) < 0.35) continue;
    queries.push_back(
        {as_seen(kind, scan_of(kind, building, truth, 1'000'000 + queries.size()), noise), truth});
  }
  return queries;
}

int right_mode(const matching::Localisation& result, const Pose2& truth, bool foreign) {
  for (std::size_t i = 0; !foreign && i < result.modes.size(); ++i)
    if (right(result.modes[i].T_map_base, truth)) return static_cast<int>(i);
  return -1;
}

void Tally::add(const matching::Localisation& result, const Pose2& truth, bool foreign) {
  const int listed = right_mode(result, truth, foreign);
  ++asked;
  first_right += listed == 0;
  if (listed != 0) most_of_wrong = std::max(most_of_wrong, result.confidence);
  if (result.tracking()) {
    ++(listed == 0 ? tracking_right : tracking_wrong);
  } else if (result.state == matching::LocalisationState::kAmbiguous) {
    ++ambiguous;
    ambiguous_listed += listed >= 0;
  } else {
    ++lost;
  }
}

void Tally::print(const std::string& name) const {
  std::printf(
      "%-28s %5d: TRACKING %4d right, %d wrong; AMBIGUOUS %4d (right one listed %4d); LOST %4d; "
      "first mode right %4d, most said of a wrong one %.3f\n",
      name.c_str(), asked, tracking_right, tracking_wrong, ambiguous, ambiguous_listed, lost,
      first_right, most_of_wrong);
}

}  // namespace voxlist::bench
