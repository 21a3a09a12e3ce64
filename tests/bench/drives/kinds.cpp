#include "tests/bench/drives/kinds.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace voxlist::bench {
namespace {

using enum Place;
using enum Laser;
using enum Wheels;

constexpr std::pair<Wheels, const char*> kWheels[] = {
    {kExact, "exact"}, {kDrifting, "drifting"}, {kSlipping, "slipping"}, {kNone, "none"}};
constexpr std::pair<Laser, const char*> kLasers[] = {
    {k16Rings, "16 rings"}, {k25Rings, "25 rings"}, {k49Rings, "49 rings"}, {kMirror, "mirror"}};
constexpr double kSteps_m[] = {0.1, 0.25, 0.5, 1.0};

// A corridor is driven along for so far (m), in at most so many scans.
constexpr double kCorridor_m = 10.0;
constexpr int kMostScans = 25;

void add_corridors(std::vector<DriveSpec>& drives) {
  for (const auto& [place, where] :
       {std::pair{kBareCorridor, "bare corridor"}, std::pair{kCorridorWithDoors, "doors"}})
    for (const auto& [laser, seen] : kLasers)
      for (const auto& [wheels, driven] : kWheels)
        for (const double step_m : kSteps_m) {
          if (laser == k25Rings) continue;
          char step[16];
          std::snprintf(step, sizeof step, ", %.2f m", step_m);
          drives.push_back(
              {.name = std::string(where) + ", " + seen + ", " + driven + step,
               .place = place,
               .laser = laser,
               .wheels = wheels,
               .step_m = step_m,
               .scans =
                   std::min(kMostScans, 1 + static_cast<int>(std::lround(kCorridor_m / step_m)))});
        }
}

// Maps that the drive makes, and of one scan.
void add_sparse(std::vector<DriveSpec>& drives) {
  for (const auto& [laser, seen] : kLasers)
    for (const auto& [wheels, driven] : {kWheels[1], kWheels[3]}) {
      const std::string by = std::string(seen) + ", " + driven;
      drives.push_back({.name = "floor, " + by, .laser = laser, .wheels = wheels});
      for (const double step_m : {0.6, 1.5})
        drives.push_back(
            {.name = "one-scan map, street, " + by + (step_m < 1.0 ? ", 0.6 m" : ", 1.5 m"),
             .place = kStreet,
             .laser = laser,
             .wheels = wheels,
             .step_m = step_m,
             .scans = 2});
      drives.push_back(
          {.name = "one-scan map, floor, " + by, .laser = laser, .wheels = wheels, .scans = 2});
      if (laser != kMirror)
        drives.push_back({.name = "street, " + by,
                          .place = kStreet,
                          .laser = laser,
                          .wheels = wheels,
                          .step_m = 0.6,
                          .scans = 25});
    }
}

void add_bad(std::vector<DriveSpec>& drives) {
  for (const int bad_scans : {1, 5})
    for (const Bad bad : kAllBad)
      for (const auto& [wheels, driven] : {kWheels[1], kWheels[3]})
        for (const Laser laser : {k25Rings, kMirror})
          drives.push_back({.name = std::to_string(bad_scans) + " bad (" + name(bad) + "), " +
                                    kLasers[static_cast<int>(laser)].second + ", " + driven,
                            .laser = laser,
                            .wheels = wheels,
                            .bad = bad,
                            .bad_scans = bad_scans});
}

}  // namespace

std::vector<DriveSpec> all_drives() {
  std::vector<DriveSpec> drives;
  for (const auto& [wheels, driven] : {kWheels[1], kWheels[3]}) {
    const std::string by = std::string(", ") + driven;
    drives.push_back({.name = "mapped" + by, .wheels = wheels, .mapped = true});
    drives.push_back({.name = "mapped, tilt refine" + by,
                      .wheels = wheels,
                      .mapped = true,
                      .tilt = TiltUse::kRefine});
    drives.push_back(
        {.name = "mapped, changed" + by, .wheels = wheels, .mapped = true, .changed = true});
    drives.push_back(
        {.name = "mapped, carried away" + by, .wheels = wheels, .mapped = true, .carried = true});
    drives.push_back(
        {.name = "floor, people, short returns" + by, .wheels = wheels, .changed = true});
    drives.push_back({.name = "floor, 64,000 rays" + by, .laser = k64000Rays, .wheels = wheels});
  }
  add_sparse(drives);
  add_bad(drives);
  add_corridors(drives);
  return drives;
}

}  // namespace voxlist::bench
