// A map of one scan of one point.
#include <voxlist/voxels/occupancy_map.h>

int main() {
  voxlist::OccupancyMap map;
  voxlist::Cloud cloud;
  cloud.points = {{1.0F, 0.5F, 0.2F}};
  voxlist::add_scan(cloud, voxlist::Pose3::Identity(), 30.0, map);
  return map.empty() ? 1 : 0;
}
