#include "voxlist/matching/search/global_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>

#include "voxlist/matching/counting/turned_points.h"
#include "voxlist/matching/counting/window_counters.h"

namespace voxlist::matching {
namespace {

constexpr std::int32_t kFactor = CoarseMap::kFactor;
constexpr std::int32_t kGroup = TurnedPoints::kGroup;

// The first band of bounds is this part of the points wide; each is twice as wide as the one
// before.
constexpr int kBands = 64;

// Translations [8 x, 8 x + 8) x [8 y, 8 y + 8) at the angles of a group.
struct Node {
  int bound;
  std::int32_t group, x, y;
};

struct LatticePose {
  int overlap;
  std::int32_t angle, x, y;  // cells of the map
};

// Upper bounds of all nodes.
class Bounds {
 public:
  Bounds(const CoarseMap& map, const TurnedPoints& points, Instructions instructions)
      : map_(map), counts_(static_cast<std::size_t>(points.groups())), highest_(counts_.size()) {
    tbb::parallel_for(std::size_t{0}, counts_.size(), [&](std::size_t group) {
      counts_[group] = coarse_sweep(map, points.coarse_cells(static_cast<std::int32_t>(group), map),
                                    instructions);
      for (std::size_t word = 0; word < counts_[group].words; ++word)
        highest_[group].push_back(static_cast<std::uint16_t>(largest(counters_at(group, word))));
    });
  }

  // The nodes with a bound from `least` to `most`: near ones together, that look at the same part
  // of the map, and then by group, y, x.
  std::vector<Node> nodes_between(int least, int most) const {
    std::vector<Node> nodes;
    for (std::size_t group = 0; group < counts_.size(); ++group) {
      for (std::size_t word = 0; word < counts_[group].words; ++word) {
        if (highest_[group][word] < least) continue;
        const WindowCounters counters = counters_at(group, word);
        const std::uint64_t lanes = lanes_from(counters, least) & ~lanes_from(counters, most + 1);
        for_each_lane(lanes, [&](int lane) {
          const std::int64_t bit = static_cast<std::int64_t>(64 * word) + lane;
          const Node node{count_of(counters, lane), static_cast<std::int32_t>(group),
                          static_cast<std::int32_t>(bit % map_.row_bits()),
                          static_cast<std::int32_t>(bit / map_.row_bits())};
          if (node.x < map_.size_x() && node.y < map_.size_y()) nodes.push_back(node);
        });
      }
    }
    return by_tile(nodes);
  }

  // No node's bound is higher.
  int highest() const {
    int best = 0;
    for (const auto& words : highest_)
      for (const std::uint16_t highest : words) best = std::max<int>(best, highest);
    return best;
  }

 private:
  std::vector<Node> by_tile(const std::vector<Node>& nodes) const {
    constexpr std::int32_t kTile = 16;
    const std::int32_t columns = map_.size_x() / kTile + 1;
    const auto tile_of = [&](const Node& node) {
      return static_cast<std::size_t>(node.y / kTile * columns + node.x / kTile);
    };
    std::vector<std::size_t> ends(static_cast<std::size_t>(columns * (map_.size_y() / kTile + 1)) +
                                  1);
    for (const Node& node : nodes) ++ends[tile_of(node) + 1];
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    std::vector<Node> sorted(nodes.size());
    for (const Node& node : nodes) sorted[ends[tile_of(node)]++] = node;
    return sorted;
  }

  WindowCounters counters_at(std::size_t group, std::size_t word) const {
    const NodeCounts& counts = counts_[group];
    WindowCounters counters;
    for (std::size_t p = 0; p < kCountPlanes; ++p)
      counters.planes[p] = counts.planes[p * counts.words + word];
    return counters;
  }

  const CoarseMap& map_;
  std::vector<NodeCounts> counts_;                   // by group
  std::vector<std::vector<std::uint16_t>> highest_;  // of each word of counts
};

// Counts the poses of nodes, 64 at a time: for all angles of a node at once on blurred maps, then
// for half of them, and so on, only as long as one of the translations can matter.
class PoseCounter {
 public:
  PoseCounter(const TolerantMap& map, TurnedPoints& points) : map_(map), points_(points) {}

  // Calls visit(LatticePose) for the poses of a node that have at least least(), which may rise
  // from one to the next.
  template <class Least, class Visit>
  void poses_from(const Node& node, const Least& least, const Visit& visit) {
    poses_from(node, 0, ~std::uint64_t{0}, least, visit);
  }

 private:
  template <class Least, class Visit>
  void poses_from(const Node& node, std::int32_t part, std::uint64_t lanes, const Least& least,
                  const Visit& visit) {
    const WindowCounters counters = count(node, part, lanes, least());
    lanes &= lanes_from(counters, least());
    if (lanes == 0) return;
    if (part < TurnedPoints::kFirstSingle) {
      poses_from(node, 2 * part + 1, lanes, least, visit);
      poses_from(node, 2 * part + 2, lanes, least, visit);
      return;
    }
    const std::int32_t angle = node.group * kGroup + part - TurnedPoints::kFirstSingle;
    for_each_lane(lanes, [&](int lane) {
      visit(LatticePose{count_of(counters, lane), angle, node.x * kFactor + lane / kFactor,
                        node.y * kFactor + lane % kFactor});
    });
  }

  // Stops early, below `least`, when no lane can reach it any more.
  WindowCounters count(const Node& node, std::int32_t part, std::uint64_t lanes, int least) {
    constexpr std::size_t kCheckEvery = 64;
    const auto places = points_.places(node.group, part);
    const std::int64_t moved = map_.moved(node.x, node.y);
    WindowCounters counters;
    for (std::size_t begin = 0; begin < places.size(); begin += kCheckEvery) {
      const std::size_t end = std::min(places.size(), begin + kCheckEvery);
      for (std::size_t i = begin; i < end; i += 8) {
        std::uint64_t words[8] = {};
        for (std::size_t k = 0; k < std::min<std::size_t>(8, end - i); ++k)
          words[k] = map_.window(places[i + k], moved);
        counters.add8(words);
      }
      const auto rest = static_cast<int>(places.size() - end);
      if ((lanes & lanes_from(counters, std::max(0, least - rest))) == 0) return {};
    }
    return counters;
  }

  const TolerantMap& map_;
  TurnedPoints& points_;
};

// The modes of the poses so far: the best pose, then the best one that is distinct from it, and so
// on.
class Modes {
 public:
  explicit Modes(const SearchConfig& config) : config_(config) {}

  // What a pose must have to matter.
  int least() const { return std::max({1, floor(), full() ? modes_.back().overlap + 1 : 0}); }

  void add(const OverlapMode& pose) {
    if (pose.overlap < least()) return;
    poses_.push_back(pose);
    if (!hidden(pose)) choose();
  }

  int best() const { return modes_.empty() ? 0 : modes_.front().overlap; }

  // Best first; none with less than mode_ratio of the best.
  const std::vector<OverlapMode>& modes() const { return modes_; }

 private:
  int floor() const { return static_cast<int>(std::ceil(config_.mode_ratio * best())); }
  bool full() const { return modes_.size() >= config_.max_modes; }

  // By a mode that is as good.
  bool hidden(const OverlapMode& pose) const {
    return std::any_of(modes_.begin(), modes_.end(), [&](const OverlapMode& mode) {
      return mode.overlap >= pose.overlap &&
             distance_m(mode.pose, pose.pose) < config_.mode_distance_m &&
             turn_rad(mode.pose, pose.pose) < config_.mode_turn_rad;
    });
  }

  // From all poses: the modes that a new one hides may have hidden others.
  void choose() {
    std::stable_sort(poses_.begin(), poses_.end(),
                     [](const auto& a, const auto& b) { return a.overlap > b.overlap; });
    modes_.assign(1, poses_.front());
    std::erase_if(poses_, [&](const OverlapMode& pose) { return pose.overlap < floor(); });
    for (const OverlapMode& pose : poses_)
      if (!full() && !hidden(pose)) modes_.push_back(pose);
  }

  const SearchConfig& config_;
  std::vector<OverlapMode> poses_, modes_;
};

// Whether a search can count the point: false for what is not finite, too.
bool within_reach(const CoarseMap& map, const Eigen::Vector3f& p) {
  return in_lattice(p, kFinestResolution_m) &&
         p.head<2>().cast<double>().squaredNorm() <= map.reach_m() * map.reach_m();
}

// The numbers below n in an order of which any first part is spread evenly, so that hopeless poses
// are given up early: by their fractions of the golden ratio.
std::vector<std::size_t> golden_order(std::size_t n) {
  constexpr double kGolden = 0.6180339887498949;
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < n; ++i)
    order.emplace_back(std::fmod(static_cast<double>(i) * kGolden, 1.0), i);
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> numbers;
  for (const auto& [fraction, number] : order) numbers.push_back(number);
  return numbers;
}

}  // namespace

GlobalMap::GlobalMap(const VoxelMap& map, double finest_m, double reach_m)
    : tolerant_(
          map,
          [&] {
            constexpr double kMostCells = 800.0;
            double cell_m = finest_m;
            while (reach_m > kMostCells * cell_m) cell_m *= 2.0;
            return cell_m;
          }(),
          reach_m),
      coarse_(tolerant_, reach_m) {}

std::vector<Eigen::Vector3f> GlobalMap::choose_points(const PreparedScan& scan,
                                                      std::size_t most) const {
  const auto points = scan.search_points(telling(scan));
  std::vector<Eigen::Vector3f> chosen;
  const std::size_t n = std::min({most, kMostSearchPoints, points.size()});
  for (const std::size_t i : golden_order(n)) chosen.push_back(points[i * points.size() / n]);
  return chosen;
}

// Indices of the points within reach that do not lie in layers which the map fills. They are left
// out before the scan is thinned: the cubes at the foot of a wall would else be the floor's.
std::vector<std::uint32_t> GlobalMap::telling(const PreparedScan& scan) const {
  constexpr double kFull = 0.5;         // of the ground plan
  constexpr double kFewestKept = 0.05;  // of the points; fewer tell nothing, so that all are kept
  std::vector<std::uint32_t> near, telling;
  for (const std::uint32_t i : scan.in_range()) {
    const Eigen::Vector3f& p = scan.cloud().points[i];
    if (!within_reach(coarse_, p)) continue;
    near.push_back(i);
    if (tolerant_.fill(tolerant_.layer(double(p.z()))) < kFull) telling.push_back(i);
  }
  return double(telling.size()) < kFewestKept * double(near.size()) ? near : telling;
}

SearchResult global_search(const GlobalMap& map, std::span<const Eigen::Vector3f> points,
                           const SearchConfig& config, Instructions instructions) {
  if (points.size() > kMostSearchPoints ||
      !std::all_of(points.begin(), points.end(),
                   [&](const auto& p) { return within_reach(map.coarse(), p); }))
    throw std::invalid_argument("global_search: too many points, or one beyond the map's reach");
  SearchResult result;
  const TolerantMap& tolerant = map.tolerant();
  TurnedPoints turned(tolerant, points);
  if (tolerant.empty() || turned.size() == 0) return result;

  const Bounds bounds(map.coarse(), turned, instructions);
  PoseCounter counter(tolerant, turned);
  const auto pose_of = [&](const LatticePose& pose) {
    return Pose2{(tolerant.lowest().x + pose.x) * tolerant.cell_m(),
                 (tolerant.lowest().y + pose.y) * tolerant.cell_m(),
                 wrap_angle(turned.yaw_rad(pose.angle))};
  };
  Modes modes(config);
  const auto look_at = [&](const Node& node) {
    counter.poses_from(
        node, [&] { return modes.least(); },
        [&](const LatticePose& pose) {
          modes.add({pose_of(pose), pose.overlap});
        });
  };

  // Bands of bounds, the highest first. The narrow first ones give an answer that tells which of
  // the other nodes can matter.
  int band = 1 + static_cast<int>(turned.size()) / kBands;
  int top = bounds.highest();
  std::int64_t nodes = 0;
  result.complete = true;
  for (; top >= modes.least() && result.complete; top -= band, band *= 2) {
    for (const Node& node : bounds.nodes_between(std::max(modes.least(), top - band + 1), top)) {
      if (node.bound < modes.least()) continue;
      if (nodes >= config.max_nodes && modes.best() > 0) {
        result.complete = false;
        result.bound = top;
        break;
      }
      ++nodes;
      look_at(node);
    }
  }
  result.bound = std::max(result.bound, modes.best());
  result.certified = modes.best() > 0 && result.bound == modes.best();
  const double poses_in_node = double(kFactor) * kFactor * kGroup;
  const double all_nodes = double(map.coarse().size_x()) * map.coarse().size_y() * turned.groups();
  result.lattice_poses = all_nodes * poses_in_node;
  result.poses_examined = static_cast<std::int64_t>(all_nodes + double(nodes) * poses_in_node);
  result.modes = modes.modes();
  return result;
}

}  // namespace voxlist::matching
