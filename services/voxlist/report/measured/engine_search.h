#pragma once

#include "services/voxlist/report/measured/scene.h"
#include "voxlist/matching/search/search_result.h"

namespace voxlist::desk {

/// A search of the whole map by the engine, on one thread.
struct EngineSearch {
  matching::SearchResult found;
  double seconds = 0.0;  ///< CPU time
};

/// Searches maps for scans at one resolution of the lattice. Makes the map ready when it is made.
class EngineAt {
 public:
  EngineAt(const VoxelMap& map, double resolution_m);
  ~EngineAt();

  EngineSearch search(const Cloud& scan) const;

 private:
  struct Ready;
  std::unique_ptr<Ready> ready_;
};

}  // namespace voxlist::desk
