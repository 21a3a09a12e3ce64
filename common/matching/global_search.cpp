#include "matching/global_search.h"

#include <tbb/parallel_for.h>
#include <time.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "matching/bit_counters.h"

namespace voxlist {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr std::int32_t kGroup = CoarseMap::kFactor;  // angles of a node
constexpr std::size_t kLeafPlanes = 13;

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

struct Cell {
  std::int16_t x, y;
};

struct Node {
  int bound;
  std::int32_t group, x, y;  // coarse translation
};

// The largest counter of a window, and one lane that has it.
template <std::size_t kPlanes>
std::pair<int, int> maximum(const BitCounters<std::uint64_t, kPlanes>& counters) {
  std::uint64_t lanes = ~std::uint64_t{0};
  int value = 0;
  for (std::size_t p = kPlanes; p-- > 0;) {
    if (const std::uint64_t with = lanes & counters.planes[p]) {
      lanes = with;
      value |= 1 << p;
    }
  }
  return {value, std::countr_zero(lanes)};
}

// The best few distinct modes so far.
class Modes {
 public:
  explicit Modes(const GlobalSearchConfig& config) : config_(config) {}

  // What a further one must have to matter.
  int least() const { return modes_.size() < config_.max_modes ? 0 : modes_.back().overlap + 1; }

  void add(const GlobalMode& mode) {
    const auto same = [&](const GlobalMode& other) {
      return distance_m(mode.pose, other.pose) < config_.mode_distance_m &&
             turn_rad(mode.pose, other.pose) < config_.mode_turn_rad;
    };
    const auto known = std::find_if(modes_.begin(), modes_.end(), same);
    if (known != modes_.end() && known->overlap >= mode.overlap) return;
    std::erase_if(modes_, same);
    const auto behind = std::find_if(modes_.begin(), modes_.end(), [&](const GlobalMode& other) {
      return other.overlap < mode.overlap;
    });
    modes_.insert(behind, mode);
    if (modes_.size() > config_.max_modes) modes_.pop_back();
  }

  const std::vector<GlobalMode>& best() const { return modes_; }

 private:
  const GlobalSearchConfig& config_;
  std::vector<GlobalMode> modes_;  // by falling overlap
};

class Search {
 public:
  Search(const TolerantMap& map, const CoarseMap& coarse, std::span<const Eigen::Vector3f> points,
         const GlobalSearchConfig& config)
      : map_(map), coarse_(coarse), config_(config) {
    double radius = map.cell_m();
    for (const auto& p : points) {
      const auto z = static_cast<std::int32_t>(
                         std::floor(static_cast<double>(p.z()) / map.cell_height_m())) -
                     map.lowest().z;
      if (z < 0 || z >= map.size_z()) continue;
      points_.push_back({p.x(), p.y()});
      layers_.push_back(z);
      layer_offsets_.push_back(static_cast<std::int32_t>(map.offset(0, 0, z)));
      radius = std::max(radius, double(p.head<2>().norm()));
    }
    const auto finest = static_cast<std::int32_t>(std::ceil(kTwoPi * radius / map.cell_m()));
    groups_ = (finest + kGroup - 1) / kGroup;
    angles_ = groups_ * kGroup;
  }

  GlobalSearchResult run() {
    GlobalSearchResult result;
    const double t0 = cpu_ms();
    const double t1 = cpu_ms();
    sweep();
    const double t2 = cpu_ms();
    descend(result);
    result.ms_cells = t1 - t0;
    result.ms_sweep = t2 - t1;
    result.ms_leaves = cpu_ms() - t2;
    result.lattice_poses = double(angles_) * map_.size_x() * map_.size_y();
    return result;
  }

 private:
  double yaw(std::int32_t angle) const { return kTwoPi * angle / angles_; }

  // Turns all points by all angles, group by group: offsets of their windows for the leaves, coarse
  // cells with their counts for the nodes.
  void sweep() {
    const std::size_t n = points_.size();
    offsets_.resize(n * static_cast<std::size_t>(angles_));
    cells_.resize(offsets_.size());
    boxes_.resize(static_cast<std::size_t>(angles_));
    counts_.resize(static_cast<std::size_t>(groups_));
    tbb::parallel_for(0, groups_, [&](std::int32_t g) {
      Reach reach(n);
      for (std::int32_t a = g * kGroup; a < (g + 1) * kGroup; ++a) turn(a, reach);
      coarse_sweep(coarse_, coarse_cells(reach), {0, 0, coarse_.size_x(), coarse_.size_y()},
                   config_.instructions, counts_[static_cast<std::size_t>(g)]);
    });
  }

  // Lowest and highest cell of each point over the angles of a group.
  struct Reach {
    explicit Reach(std::size_t n) : low_x(n, kFar), low_y(n, kFar), high_x(n, -kFar), high_y(n, -kFar) {}
    static constexpr std::int32_t kFar = 1 << 29;
    std::vector<std::int32_t> low_x, low_y, high_x, high_y;
  };

  struct CellBox {
    std::int32_t low_x, low_y, high_x, high_y;
  };

  void turn(std::int32_t angle, Reach& reach) {
    const auto c = static_cast<float>(std::cos(yaw(angle)) / map_.cell_m()),
               s = static_cast<float>(std::sin(yaw(angle)) / map_.cell_m());
    const std::size_t n = points_.size();
    std::int32_t* out = offsets_.data() + n * static_cast<std::size_t>(angle);
    Cell* cells = cells_.data() + n * static_cast<std::size_t>(angle);
    CellBox box{Reach::kFar, Reach::kFar, -Reach::kFar, -Reach::kFar};
    for (std::size_t i = 0; i < n; ++i) {
      const float px = points_[i].x(), py = points_[i].y();
      const auto x = static_cast<std::int32_t>(std::floor(c * px - s * py)),
                 y = static_cast<std::int32_t>(std::floor(s * px + c * py));
      reach.low_x[i] = std::min(reach.low_x[i], x);
      reach.low_y[i] = std::min(reach.low_y[i], y);
      reach.high_x[i] = std::max(reach.high_x[i], x);
      reach.high_y[i] = std::max(reach.high_y[i], y);
      box = {std::min(box.low_x, x), std::min(box.low_y, y), std::max(box.high_x, x), std::max(box.high_y, y)};
      out[i] = layer_offsets_[i] + y * map_.size_x() + x;
      cells[i] = {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)};
    }
    boxes_[static_cast<std::size_t>(angle)] = box;
  }

  std::vector<CoarseCell> coarse_cells(const Reach& reach) const {
    const std::size_t n = points_.size();
    std::vector<std::int64_t> bits(n);
    for (std::size_t i = 0; i < n; ++i) {
      const std::int32_t x = reach.low_x[i] >> 3, y = reach.low_y[i] >> 3;
      const int wide_x = reach.high_x[i] - 8 * x > 8, wide_y = reach.high_y[i] - 8 * y > 8;
      bits[i] = coarse_.bit(wide_x, wide_y, x, y, layers_[i]);
    }
    std::sort(bits.begin(), bits.end());
    std::vector<CoarseCell> merged;
    for (const std::int64_t bit : bits) {
      if (merged.empty() || merged.back().bit != bit) merged.push_back({bit, 0});
      ++merged.back().weight;
    }
    return merged;
  }

  // All nodes with a count of at least `least`, best first.
  std::vector<Node> nodes_from(int least) const {
    std::vector<Node> nodes;
    for (std::int32_t g = 0; g < groups_; ++g) {
      const NodeCounts& counts = counts_[static_cast<std::size_t>(g)];
      for (std::size_t w = 0; w < counts.words; ++w) {
        std::uint64_t planes[kCountPlanes];
        for (std::size_t p = 0; p < kCountPlanes; ++p) planes[p] = counts.planes[p * counts.words + w];
        // Lanes with count >= least: compare from the highest digit down.
        std::uint64_t greater = 0, equal = ~std::uint64_t{0};
        for (std::size_t p = kCountPlanes; p-- > 0;) {
          if (least >> p & 1) {
            equal &= planes[p];
          } else {
            greater |= equal & planes[p];
            equal &= ~planes[p];
          }
        }
        for (std::uint64_t lanes = greater | equal; lanes != 0; lanes &= lanes - 1) {
          const int lane = std::countr_zero(lanes);
          const std::int64_t at = static_cast<std::int64_t>(w * 64) + lane;
          const auto x = static_cast<std::int32_t>(at % coarse_.row_bits()), y = static_cast<std::int32_t>(at / coarse_.row_bits());
          if (x >= coarse_.size_x() || y >= coarse_.size_y()) continue;
          int count = 0;
          for (std::size_t p = 0; p < kCountPlanes; ++p)
            count |= static_cast<int>(planes[p] >> lane & 1) << p;
          nodes.push_back({count, g, x, y});
        }
      }
    }
    std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) {
      return std::tie(b.bound, a.group, a.y, a.x) < std::tie(a.bound, b.group, b.y, b.x);
    });
    return nodes;
  }

  // Garbage lanes between rows may have higher counts: a bound still.
  int highest_bound() const {
    int best = 0;
    for (const NodeCounts& counts : counts_) {
      for (std::size_t w = 0; w < counts.words; ++w) {
        std::uint64_t lanes = ~std::uint64_t{0};
        int value = 0;
        for (std::size_t p = kCountPlanes; p-- > 0;) {
          if (const std::uint64_t with = lanes & counts.planes[p * counts.words + w]) {
            lanes = with;
            value |= 1 << p;
          }
        }
        best = std::max(best, value);
      }
    }
    return best;
  }

  // The best pose of a node, if it has one of at least `least`.
  GlobalMode best_of(const Node& node, int least) const {
    GlobalMode best;
    best.overlap = least - 1;
    for (std::int32_t a = node.group * kGroup; a < (node.group + 1) * kGroup; ++a) {
      const auto [count, lane] = window(a, node.x * kGroup, node.y * kGroup, best.overlap + 1);
      if (count <= best.overlap) continue;
      best.overlap = count;
      best.pose = {(map_.lowest().x + node.x * kGroup + lane / 8) * map_.cell_m(),
                   (map_.lowest().y + node.y * kGroup + lane % 8) * map_.cell_m(),
                   wrap_angle(yaw(a))};
    }
    return best;
  }

  // The best translation of an 8 x 8 window; gives up early when none can reach `least`.
  std::pair<int, int> window(std::int32_t angle, std::int32_t x, std::int32_t y, int least) const {
    const CellBox& box = boxes_[static_cast<std::size_t>(angle)];
    const bool inside = map_.holds(box.low_x + x, box.low_y + y) && map_.holds(box.high_x + x, box.high_y + y);
    const std::int64_t at = map_.offset(x, y, 0);
    const std::size_t first = points_.size() * static_cast<std::size_t>(angle);
    const std::int32_t* offsets = offsets_.data() + first;
    const Cell* cells = cells_.data() + first;
    return inside ? count(least, [&](std::size_t i) { return map_.window(at + offsets[i]); })
                  : count(least, [&](std::size_t i) { return window_at_edge(cells[i], layers_[i], x, y); });
  }

  // The same for a window that may reach past the map.
  std::uint64_t window_at_edge(const Cell& cell, std::int32_t z, std::int32_t x, std::int32_t y) const {
    const std::int32_t cx = cell.x + x, cy = cell.y + y;
    if (map_.holds(cx, cy)) return map_.window(map_.offset(cx, cy, z));
    if (cx <= -8 || cy <= -8 || cx >= map_.size_x() || cy >= map_.size_y()) return 0;
    std::uint64_t bits = 0;
    for (int b = 0; b < 64; ++b)
      bits |= std::uint64_t{map_.occupied(cx + b / 8, cy + b % 8, z)} << b;
    return bits;
  }

  template <class Window>
  std::pair<int, int> count(int least, const Window& window) const {
    BitCounters<std::uint64_t, kLeafPlanes> counters;
    const std::size_t n = points_.size();
    constexpr std::size_t kCheck = 128;
    for (std::size_t begin = 0; begin < n; begin += kCheck) {
      const std::size_t end = std::min(n, begin + kCheck);
      for (std::size_t i = begin; i < end; i += 8) {
        std::uint64_t w[8];
        for (std::size_t k = 0; k < 8; ++k) w[k] = i + k < end ? window(i + k) : 0;
        counters.add8(w);
      }
      if (end == n) break;
      const auto so_far = maximum(counters);
      if (so_far.first + static_cast<int>(n - end) < least) return so_far;
    }
    return maximum(counters);
  }

  void descend(GlobalSearchResult& result) {
    const int highest = highest_bound();
    // A first answer, from the nodes that promise most: it tells which others matter.
    int best = 0;
    for (int least = highest; best == 0 && least > 0; least = least * 9 / 10) {
      const std::vector<Node> top = nodes_from(least);
      for (std::size_t i = 0; i < std::min<std::size_t>(top.size(), 16); ++i)
        best = std::max(best, best_of(top[i], best + 1).overlap);
    }
    const auto floor_of = [&](int overlap) {
      return std::max(1, static_cast<int>(std::ceil(config_.mode_ratio * overlap)));
    };
    const std::vector<Node> nodes = nodes_from(floor_of(best));
    result.nodes = static_cast<std::int64_t>(nodes.size());
    result.certified = result.complete = true;
    Modes modes(config_);
    for (const Node& node : nodes) {
      const int least = std::max(floor_of(best), modes.least());
      if (node.bound < least) break;
      if (++result.leaves > config_.max_leaves) {
        result.complete = false;
        result.certified = node.bound <= best;
        result.bound = std::max(best, node.bound);
        break;
      }
      const GlobalMode mode = best_of(node, least);
      if (mode.overlap < least) continue;
      best = std::max(best, mode.overlap);
      modes.add(mode);
    }
    result.bound = std::max(result.bound, best);
    for (const GlobalMode& mode : modes.best())
      if (mode.overlap >= floor_of(best)) result.modes.push_back(mode);
  }

  const TolerantMap& map_;
  const CoarseMap& coarse_;
  const GlobalSearchConfig config_;
  std::vector<Eigen::Vector2f> points_;
  std::vector<std::int32_t> layers_, layer_offsets_;
  std::vector<std::int32_t> offsets_;  // of the windows, by angle and point
  std::vector<Cell> cells_;
  std::vector<CellBox> boxes_;
  std::int32_t groups_ = 0, angles_ = 0;
  std::vector<NodeCounts> counts_;
};

}  // namespace

GlobalSearchResult global_search(const TolerantMap& map, const CoarseMap& coarse,
                                 std::span<const Eigen::Vector3f> points,
                                 const GlobalSearchConfig& config) {
  if (map.empty() || points.empty()) return {};
  return Search(map, coarse, points, config).run();
}

}  // namespace voxlist
