#include "matching/global_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "matching/bit_counters.h"
#include "matching/turned_points.h"

namespace voxlist {
namespace {

constexpr std::int32_t kFactor = CoarseMap::kFactor;
constexpr std::int32_t kGroup = TurnedPoints::kGroup;

using WindowCounters = BitCounters<std::uint64_t, kCountPlanes>;

// Translations [8 x, 8 x + 8) x [8 y, 8 y + 8) at the angles of a group.
struct Node {
  int bound;
  std::int32_t group, x, y;
};

struct LatticePose {
  int overlap;
  std::int32_t angle, x, y;  // cells of the map
};

int largest(const WindowCounters& counters) {
  std::uint64_t lanes = ~std::uint64_t{0};
  int value = 0;
  for (std::size_t p = kCountPlanes; p-- > 0;) {
    if (const std::uint64_t with = lanes & counters.planes[p]) {
      lanes = with;
      value |= 1 << p;
    }
  }
  return value;
}

// Lanes of a word of counters that are at least `least`: compared from the highest digit down.
std::uint64_t lanes_from(const WindowCounters& counters, int least) {
  std::uint64_t greater = 0, equal = ~std::uint64_t{0};
  for (std::size_t p = kCountPlanes; p-- > 0;) {
    if (least >> p & 1) {
      equal &= counters.planes[p];
    } else {
      greater |= equal & counters.planes[p];
      equal &= ~counters.planes[p];
    }
  }
  return greater | equal;
}

int count_of(const WindowCounters& counters, int lane) {
  int count = 0;
  for (std::size_t p = 0; p < kCountPlanes; ++p)
    count |= static_cast<int>(counters.planes[p] >> lane & 1) << p;
  return count;
}

// Upper bounds of all nodes.
class Bounds {
 public:
  Bounds(const CoarseMap& map, TurnedPoints& points, Instructions instructions)
      : map_(map), counts_(static_cast<std::size_t>(points.groups())) {
    tbb::parallel_for(0, points.groups(), [&](std::int32_t group) {
      points.turn(group);
      counts_[static_cast<std::size_t>(group)] =
          coarse_sweep(map, points.coarse_cells(group, map), instructions);
    });
  }

  // All nodes with a bound of at least `least`, best first, in an order that depends on nothing
  // else.
  std::vector<Node> nodes_from(int least) const {
    std::vector<Node> nodes;
    for (std::size_t group = 0; group < counts_.size(); ++group) {
      for (std::size_t word = 0; word < counts_[group].words; ++word) {
        const WindowCounters counters = counters_at(group, word);
        for (std::uint64_t lanes = lanes_from(counters, least); lanes != 0; lanes &= lanes - 1) {
          const int lane = std::countr_zero(lanes);
          const std::int64_t bit = static_cast<std::int64_t>(64 * word) + lane;
          const Node node{count_of(counters, lane), static_cast<std::int32_t>(group),
                          static_cast<std::int32_t>(bit % map_.row_bits()),
                          static_cast<std::int32_t>(bit / map_.row_bits())};
          if (node.x < map_.size_x() && node.y < map_.size_y()) nodes.push_back(node);
        }
      }
    }
    std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) {
      return std::tie(b.bound, a.group, a.y, a.x) < std::tie(a.bound, b.group, b.y, b.x);
    });
    return nodes;
  }

  // No node's bound is higher.
  int highest() const {
    int best = 0;
    for (std::size_t group = 0; group < counts_.size(); ++group)
      for (std::size_t word = 0; word < counts_[group].words; ++word)
        best = std::max(best, largest(counters_at(group, word)));
    return best;
  }

 private:
  WindowCounters counters_at(std::size_t group, std::size_t word) const {
    const NodeCounts& counts = counts_[group];
    WindowCounters counters;
    for (std::size_t p = 0; p < kCountPlanes; ++p)
      counters.planes[p] = counts.planes[p * counts.words + word];
    return counters;
  }

  const CoarseMap& map_;
  std::vector<NodeCounts> counts_;  // by group
};

// Counts the poses of nodes one by one, 64 at a time.
class PoseCounter {
 public:
  PoseCounter(const TolerantMap& map, const TurnedPoints& points) : map_(map), points_(points) {}

  // Calls visit(LatticePose) for the poses of a node that have at least `least`.
  template <class Visit>
  void poses_from(const Node& node, int least, const Visit& visit) const {
    const std::int32_t x = node.x * kFactor, y = node.y * kFactor;
    for (std::int32_t angle = node.group * kGroup; angle < (node.group + 1) * kGroup; ++angle) {
      const WindowCounters counters = count_window(angle, x, y, least);
      for (std::uint64_t lanes = lanes_from(counters, least); lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        visit(LatticePose{count_of(counters, lane), angle, x + lane / kFactor, y + lane % kFactor});
      }
    }
  }

 private:
  WindowCounters count_window(std::int32_t angle, std::int32_t x, std::int32_t y, int least) const {
    if (!points_.inside(angle, x, y))
      return count(least, [&](std::size_t i) { return points_.window(angle, i, x, y); });
    const std::int32_t* places = points_.places(angle);
    const std::int64_t moved = map_.place(x, y, 0);
    return count(least, [&](std::size_t i) { return map_.window(moved + places[i]); });
  }

  // Stops early, below `least`, when no pose can reach it any more.
  template <class Window>
  WindowCounters count(int least, const Window& window) const {
    constexpr std::size_t kCheckEvery = 128;
    WindowCounters counters;
    const std::size_t n = points_.size();
    for (std::size_t begin = 0; begin < n; begin += kCheckEvery) {
      const std::size_t end = std::min(n, begin + kCheckEvery);
      for (std::size_t i = begin; i < end; i += 8) {
        std::uint64_t words[8];
        for (std::size_t k = 0; k < 8; ++k) words[k] = i + k < end ? window(i + k) : 0;
        counters.add8(words);
      }
      if (largest(counters) + static_cast<int>(n - end) < least) return {};
    }
    return counters;
  }

  const TolerantMap& map_;
  const TurnedPoints& points_;
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
         std::hypot(double(p.x()), double(p.y())) <= map.reach_m();
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
    : tolerant_(map,
                [&] {
                  constexpr double kMostCells = 800.0;
                  double cell_m = finest_m;
                  while (reach_m > kMostCells * cell_m) cell_m *= 2.0;
                  return cell_m;
                }()),
      coarse_(tolerant_, reach_m) {}

std::vector<Eigen::Vector3f> GlobalMap::choose_points(std::span<const Eigen::Vector3f> scan,
                                                      std::size_t most) const {
  constexpr double kFull = 0.5;         // of the ground plan
  constexpr double kFewestKept = 0.05;  // of the points; fewer tell nothing, so that all are kept
  std::vector<Eigen::Vector3f> near, telling;
  for (const auto& p : scan) {
    if (!within_reach(coarse_, p)) continue;
    near.push_back(p);
    if (tolerant_.fill(tolerant_.layer(double(p.z()))) < kFull) telling.push_back(p);
  }
  if (double(telling.size()) < kFewestKept * double(near.size())) telling = std::move(near);
  std::vector<Eigen::Vector3f> chosen;
  const std::size_t n = std::min({most, kMostSearchPoints, telling.size()});
  for (const std::size_t i : golden_order(n)) chosen.push_back(telling[i * telling.size() / n]);
  return chosen;
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
  const PoseCounter counter(tolerant, turned);
  const auto pose_of = [&](const LatticePose& pose) {
    return Pose2{(tolerant.lowest().x + pose.x + 0.5) * tolerant.cell_m(),
                 (tolerant.lowest().y + pose.y + 0.5) * tolerant.cell_m(),
                 wrap_angle(turned.yaw_rad(pose.angle))};
  };
  Modes modes(config);
  const auto look_at = [&](const Node& node) {
    counter.poses_from(node, modes.least(), [&](const LatticePose& pose) {
      modes.add({pose_of(pose), pose.overlap});
    });
  };

  // A first answer tells which of the other nodes can matter.
  constexpr std::size_t kFirstNodes = 16;
  for (int least = bounds.highest(); modes.best() == 0 && least > 0; least = least * 9 / 10) {
    const std::vector<Node> promising = bounds.nodes_from(least);
    for (std::size_t i = 0; i < std::min(kFirstNodes, promising.size()); ++i) look_at(promising[i]);
  }
  result.complete = true;
  result.bound = modes.best();
  std::int64_t nodes = 0;
  for (const Node& node : bounds.nodes_from(modes.least())) {
    if (node.bound < modes.least()) break;
    if (nodes == config.max_nodes) {
      result.complete = false;
      result.bound = node.bound;
      break;
    }
    ++nodes;
    look_at(node);
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

}  // namespace voxlist
