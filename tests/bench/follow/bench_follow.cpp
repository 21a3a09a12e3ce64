// The follower of tests/clients on random drives at up to 1 m/s through simulated buildings, people
// stepping onto its way 2 m before it: whether it touches anything, and how soon it stands when
// OBSTACLES stop or say that nothing is seen. Arguments: first seed (1), last seed, mirror or rings
// (both), drives (no stops).
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/bench/follow/followed_drive.h"

namespace voxlist::bench {
namespace {

const char* name_of(FollowersLaser laser) {
  return laser == FollowersLaser::kMirror ? "mirror" : "rings";
}

void tell_drives(FollowersLaser laser, int first, int last) {
  int drives = 0, arrived = 0, touched = 0, people = 0, looks = 0, with_drop = 0;
  double nearest_m = 1e9, way_m = 0.0, seconds = 0.0;
  for (int seed = first; seed <= last; ++seed) {
    const FollowedDriveResult drive = follow({.seed = seed, .laser = laser});
    ++drives;
    arrived += drive.arrived;
    touched += drive.touched;
    people += drive.stepped_in;
    looks += drive.looks;
    with_drop += drive.looks_with_drop;
    nearest_m = std::min(nearest_m, drive.nearest_m);
    way_m += drive.way_m;
    seconds += drive.seconds;
    if (drive.touched || !drive.arrived)
      std::printf("  %s, seed %d: arrived %d, touched %d, nearest %.2f m, %.1f m in %.0f s\n",
                  name_of(laser), seed, drive.arrived, drive.touched, drive.nearest_m, drive.way_m,
                  drive.seconds);
  }
  std::printf(
      "%s: %d drives, %d arrived, %.0f m in %.0f s, %d people stepped in; touched %d, "
      "nearest %.2f m; %d of %d OBSTACLES with a drop\n",
      name_of(laser), drives, arrived, way_m, seconds, people, touched, nearest_m, with_drop,
      looks);
  std::fflush(stdout);
}

void tell_stops(FollowersLaser laser, int first, int last) {
  double silent_s = 0.0, blind_s = 0.0;
  for (int seed = first; seed <= last; ++seed) {
    const double from_s = 3.0 + 0.1 * (seed % 20), until_s = from_s + 4.0;
    silent_s = std::max(
        silent_s,
        follow({.seed = seed, .laser = laser, .longest_s = until_s, .silent_from_s = from_s})
            .stood_after_s);
    blind_s = std::max(
        blind_s,
        follow({.seed = seed, .laser = laser, .longest_s = until_s, .blind_from_s = from_s})
            .stood_after_s);
  }
  std::printf("%s: it moves on for at most %.2f s when OBSTACLES stop, for %.2f s when blind\n",
              name_of(laser), silent_s, blind_s);
  std::fflush(stdout);
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const int first = argc > 1 ? std::max(1, std::atoi(argv[1])) : 1,
            last = argc > 2 ? std::atoi(argv[2]) : first;
  const std::string only = argc > 3 ? argv[3] : "";
  const bool drives_alone = argc > 4 && std::string(argv[4]) == "drives";
  for (const FollowersLaser laser : {FollowersLaser::kMirror, FollowersLaser::kRings}) {
    if (!only.empty() && only != name_of(laser)) continue;
    tell_drives(laser, first, last);
    if (!drives_alone) tell_stops(laser, first, std::min(last, first + 9));
  }
}
