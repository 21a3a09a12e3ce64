#include "voxlist/matching/search/global_search.h"

#include <algorithm>
#include <stdexcept>

#include "voxlist/matching/counting/turned_points.h"
#include "voxlist/matching/search/mode_list.h"
#include "voxlist/matching/search/node_bounds.h"
#include "voxlist/matching/search/pose_counter.h"

namespace voxlist::matching {
namespace {

// The first band of bounds is this part of the points wide, and each band twice as wide as the one
// before. It changes speed alone: a narrow first band finds a good pose from few nodes, by which
// most others are passed over; narrower ones cost more passes over all bounds. A judgement.
constexpr int kBands = 64;

// A search by branch and bound.
class Search {
 public:
  Search(const GlobalMap& map, TurnedPoints& points, const SearchConfig& config,
         Instructions instructions)
      : map_(map),
        points_(points),
        config_(config),
        bounds_(map.coarse(), points, instructions),
        counter_(map.dilated(), points),
        modes_(config) {}

  // Looks at bands of bounds, the highest first. The narrow first ones give an answer that tells
  // which of the other nodes can matter.
  SearchResult run() {
    int band = 1 + static_cast<int>(points_.size()) / kBands, top = bounds_.highest();
    bool complete = true;
    for (; complete && top >= modes_.least(); band *= 2) {
      complete = search_band(std::max(modes_.least(), top - band + 1), top);
      if (complete) top -= band;
    }
    return report(complete, complete ? modes_.best() : std::max(top, modes_.best()));
  }

 private:
  // Searches the nodes with bounds from `least` to `most`. False when max_nodes ended it.
  bool search_band(int least, int most) {
    for (const Node& node : bounds_.nodes_between(least, most)) {
      if (node.bound < modes_.least()) continue;
      if (nodes_ >= config_.max_nodes && modes_.best() > 0) return false;
      ++nodes_;
      counter_.visit_poses(
          node, [&] { return modes_.least(); },
          [&](const LatticePose& pose) {
            modes_.add({pose_of(pose), pose.overlap});
          });
    }
    return true;
  }

  Pose2 pose_of(const LatticePose& pose) const {
    const DilatedMap& map = map_.dilated();
    return {(map.lowest().x + pose.x) * map.cell_m(), (map.lowest().y + pose.y) * map.cell_m(),
            wrap_angle(points_.yaw_rad(pose.angle))};
  }

  SearchResult report(bool complete, int bound) const {
    constexpr double kPosesInNode =
        double(CoarseMap::kFactor) * CoarseMap::kFactor * TurnedPoints::kGroup;
    const double nodes = double(map_.coarse().size_x()) * map_.coarse().size_y() * points_.groups();
    SearchResult result;
    result.complete = complete;
    result.bound = bound;
    result.certified = modes_.best() > 0 && bound == modes_.best();
    result.lattice_poses = nodes * kPosesInNode;
    result.poses_examined = static_cast<std::int64_t>(nodes + double(nodes_) * kPosesInNode);
    result.modes = modes_.modes();
    return result;
  }

  const GlobalMap& map_;
  TurnedPoints& points_;
  const SearchConfig& config_;
  const NodeBounds bounds_;
  PoseCounter counter_;
  ModeList modes_;
  std::int64_t nodes_ = 0;  // that were searched
};

}  // namespace

SearchResult global_search(const GlobalMap& map, std::span<const Eigen::Vector3f> points,
                           const SearchConfig& config, Instructions instructions) {
  if (points.size() > kMostSearchPoints ||
      !std::all_of(points.begin(), points.end(),
                   [&](const auto& p) { return map.within_reach(p); }))
    throw std::invalid_argument("global_search: too many points, or one beyond the map's reach");
  TurnedPoints turned(map.dilated(), points);
  if (map.dilated().empty() || turned.size() == 0) return {};
  return Search(map, turned, config, instructions).run();
}

}  // namespace voxlist::matching
