// A map of one scan, and two more scans that are found in it.
#include <voxlist/matching/localisation/localiser.h>
#include <voxlist/voxels/occupancy_map.h>

#include <cmath>
#include <cstdio>

#include "room.h"

int main() {
  voxlist::OccupancyMap map;
  const voxlist::Cloud first = room::scan({0.0, 0.0, 0.0});
  voxlist::add_scan(first, voxlist::Pose3::Identity(), 30.0, map);

  voxlist::matching::Localiser localiser(map);
  for (const voxlist::Pose2& truth :
       {voxlist::Pose2{0.2, 0.1, 0.1}, voxlist::Pose2{0.5, -0.2, 0.3}}) {
    const auto found = localiser.locate(room::scan(truth));
    if (found.modes.empty()) return std::puts("no pose at all"), 1;
    const double off_m = voxlist::distance_m(found.modes.front().T_map_base, truth);
    std::printf("%s, %.3f m off\n", voxlist::matching::name(found.state), off_m);
    if (!found.tracking() || off_m > 0.05) return 1;
  }
}
