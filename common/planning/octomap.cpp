#include "voxlist/planning/octomap.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <string>

#include "voxlist/io/files/atomic_file.h"
#include "voxlist/planning/bt_encoder.h"
#include "voxlist/planning/ot_encoder.h"
#include "voxlist/planning/scan_pipeline.h"
#include "voxlist/planning/touched.h"
#include "voxlist/voxels/counters/cut.h"

namespace voxlist::planning {
namespace {

RayRules rules_of(const OctomapConfig& config) {
  RayRules rules;
  rules.resolution_m = config.resolution_m;
  rules.min_range_m = config.min_range_m;
  rules.max_range_m = config.max_range_m;
  return rules;
}

std::size_t cells_in(const BlockBits& bits) {
  std::size_t count = 0;
  for (const std::uint64_t word : bits) count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

}  // namespace

struct OctomapBuilder::Tree {
  explicit Tree(const OctomapConfig& config)
      : rules(rules_of(config)),
        scratch(rules),
        counters(config.resolution_m,
                 CounterRule::of(config.hit_probability, config.miss_probability)) {}

  void count(const RayScratch& scan) {
    counters.add(scan);
    reach_m = std::min(reach_m, scan.reach_m());
  }

  // Calls write(counters, tiles) with what of the map is wanted.
  template <class Write>
  void write(const OctomapCut& wanted, const Write& write_part) {
    const double resolution_m =
        wanted.resolution_m == 0.0 ? rules.resolution_m : wanted.resolution_m;
    if (resolution_m == rules.resolution_m && !wanted.box) {
      tiles.update(counters);
      return write_part(counters, tiles);
    }
    CounterMap part = cut(counters, resolution_m, wanted.box);
    OctreeTiles its_tiles;
    its_tiles.update(part);
    write_part(part, its_tiles);
  }

  const RayRules rules;
  RayScratch scratch;
  CounterMap counters;
  OctreeTiles tiles;
  double reach_m = std::numeric_limits<double>::infinity();
};

OctomapBuilder::OctomapBuilder(const OctomapConfig& config)
    : tree_(std::make_unique<Tree>(config)) {}
OctomapBuilder::~OctomapBuilder() = default;
OctomapBuilder::OctomapBuilder(OctomapBuilder&&) noexcept = default;
OctomapBuilder& OctomapBuilder::operator=(OctomapBuilder&&) noexcept = default;

bool OctomapBuilder::insert(const Pose3& T_map_base, const Cloud& cloud_base,
                            const std::function<bool()>& stopped) {
  if (!tree_->scratch.mark(T_map_base, cloud_base, stopped)) return false;
  tree_->count(tree_->scratch);
  return true;
}

bool OctomapBuilder::insert_all(const std::function<std::optional<PosedCloud>()>& next, int threads,
                                const std::function<bool()>& stopped) {
  return mark_in_order(next, tree_->rules, threads, stopped,
                       [&](const RayScratch& scan) { tree_->count(scan); });
}

bool OctomapBuilder::recount(const std::vector<CloudMove>& moves,
                             const std::function<std::optional<PosedCloud>()>& all, int threads,
                             const std::function<bool()>& stopped) {
  Touched touched(tree_->scratch);
  for (const CloudMove& move : moves) {
    touched.add(move.before.T_map_base, move.before.cloud);
    if (move.T_map_base) touched.add(*move.T_map_base, move.before.cloud);
  }
  tree_->counters.forget(touched.blocks().keys());
  const auto next = [&] {
    std::optional<PosedCloud> cloud = all();
    while (cloud && !touched.is_reached_by(*cloud)) cloud = all();
    return cloud;
  };
  return mark_in_order(next, tree_->rules, threads, stopped, [&](const RayScratch& scan) {
    tree_->counters.add(scan, &touched.blocks());
  });
}

double OctomapBuilder::reach_m() const { return tree_->reach_m; }

std::vector<std::uint8_t> OctomapBuilder::binary() const {
  tree_->tiles.update(tree_->counters);
  const std::string bytes = BtEncoder(tree_->counters, tree_->tiles).file();
  return {bytes.begin(), bytes.end()};
}

void OctomapBuilder::write_bt(const std::filesystem::path& path, const OctomapCut& cut) const {
  tree_->write(cut, [&](const CounterMap& counters, OctreeTiles& tiles) {
    io::write_file_atomically(path, BtEncoder(counters, tiles).file());
  });
}

void OctomapBuilder::write_ot(const std::filesystem::path& path, const OctomapCut& cut) const {
  tree_->write(cut, [&](const CounterMap& counters, OctreeTiles& tiles) {
    io::write_file_atomically(path, OtEncoder(counters, tiles).file());
  });
}

OctomapSize OctomapBuilder::size() const {
  const CounterMap& counters = tree_->counters;
  OctomapSize size;
  for (std::size_t i = 0; i < counters.block_count(); ++i) {
    const std::size_t occupied = cells_in(counters.occupied(i));
    size.occupied += occupied;
    size.free += cells_in(counters.known(i)) - occupied;
  }
  tree_->tiles.update(tree_->counters);
  size.nodes = BtEncoder(counters, tree_->tiles).nodes();
  return size;
}

Occupancy OctomapBuilder::at(const Eigen::Vector3d& point_map) const {
  if (!in_lattice(point_map, tree_->rules.resolution_m)) return Occupancy::kUnknown;
  switch (tree_->counters.at(voxel_at(point_map, tree_->rules.resolution_m))) {
    case CellState::kFree:
      return Occupancy::kFree;
    case CellState::kOccupied:
      return Occupancy::kOccupied;
    case CellState::kUnknown:
      break;
  }
  return Occupancy::kUnknown;
}

}  // namespace voxlist::planning
