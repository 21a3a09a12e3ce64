#pragma once

#include <string>
#include <vector>

namespace voxlist::config {

/// A settings struct with a member of every kind.
struct SampleConfig {
  bool keep = true;
  int scans = 3;
  double resolution_m = 0.05;
  std::string folder = "map";
  std::vector<double> heights_m = {0.1, 1.8};
  std::vector<std::string> names = {"low", "high"};

  template <class Visitor>
  void visit(Visitor& v) {
    v("keep", keep, "keep it all");
    v("scans", scans, "how many", 1, 10);
    v("resolution_m", resolution_m, "voxel edge", 0.005, 1.0);
    v("folder", folder, "where to");
    v("heights_m", heights_m, "heights looked at", 0.0, 2.0);
    v("names", names, "what they are called");
  }
};

}  // namespace voxlist::config
