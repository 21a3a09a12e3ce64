#include "voxlist/planning/octomap.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "voxlist/io/files/atomic_file.h"
#include "voxlist/planning/bt_encoder.h"
#include "voxlist/planning/ot_encoder.h"
#include "voxlist/planning/scan_pipeline.h"
#include "voxlist/planning/touched.h"
#include "voxlist/voxels/counters/cut.h"
#include "voxlist/voxels/edits/edited_counters.h"

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

// The box whose edges lie within its first and its last voxels.
VoxelBox box_between(const std::vector<double>& m, double resolution_m) {
  const Voxel a = voxel_at(Eigen::Vector3d(m[0], m[1], m[2]), resolution_m);
  const Voxel b = voxel_at(Eigen::Vector3d(m[3], m[4], m[5]), resolution_m);
  return {{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
          {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
}

}  // namespace

OctomapCut cut_of(const OctomapConfig& config) {
  if (!config.export_box_m.empty() && config.export_box_m.size() != 6)
    throw std::invalid_argument("export_box_m has two corners, six numbers, or none");
  if (config.export_resolution_m != 0.0 && config.export_resolution_m < config.resolution_m)
    throw std::invalid_argument("export_resolution_m is not below resolution_m, or 0");
  OctomapCut cut;
  cut.resolution_m = config.export_resolution_m;
  if (!config.export_box_m.empty()) cut.box = box_between(config.export_box_m, config.resolution_m);
  return cut;
}

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

  // Returns what use(counters, tiles) returns, with what of the map is wanted.
  template <class Use>
  auto with(const OctomapCut& wanted, const Use& use) {
    follow();
    const double resolution_m =
        wanted.resolution_m == 0.0 ? rules.resolution_m : wanted.resolution_m;
    CounterMap& all = whole();
    if (resolution_m == rules.resolution_m && !wanted.box) return use(all, tiles);
    if (!part || part->cut != wanted) {
      part.emplace(wanted, CutMap(all, resolution_m, wanted.box));
      part->follow();
    }
    return use(part->counters.map(), part->tiles);
  }

  // The counters with edits.
  CounterMap& whole() { return edited ? edited->map() : counters; }

  void edit(const std::vector<PlacedBox>& boxes) {
    if (boxes.empty() && !edited) return;
    edited.reset();
    if (!boxes.empty()) edited.emplace(counters, boxes);
    counters.take_changed();
    whole().take_changed();
    tiles = {};
    part.reset();
    std::vector<std::uint32_t> all(whole().block_count());
    std::iota(all.begin(), all.end(), 0u);
    tiles.update(whole(), all);
  }

  // Brings trees up to date with the counters.
  void follow() {
    std::vector<std::uint32_t> changed = counters.take_changed();
    if (edited) {
      edited->update(counters, changed);
      changed = edited->map().take_changed();
    }
    tiles.update(whole(), changed);
    if (!part) return;
    part->counters.update(whole(), changed);
    part->follow();
  }

  // The part of the map that was asked for last.
  struct Part {
    Part(const OctomapCut& of, CutMap map) : cut(of), counters(std::move(map)) {}

    void follow() { tiles.update(counters.map(), counters.map().take_changed()); }

    OctomapCut cut;
    CutMap counters;
    OctreeTiles tiles;
  };

  const RayRules rules;
  RayScratch scratch;
  CounterMap counters;
  std::optional<EditedCounters> edited;
  OctreeTiles tiles;  // of the counters with edits
  std::optional<Part> part;
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

void OctomapBuilder::edit(const std::vector<PlacedBox>& boxes) { tree_->edit(boxes); }

double OctomapBuilder::reach_m() const { return tree_->reach_m; }

std::vector<std::uint8_t> OctomapBuilder::binary(const OctomapCut& cut) const {
  return tree_->with(cut, [](const CounterMap& counters, OctreeTiles& tiles) {
    const std::string bytes = BtEncoder(counters, tiles).file();
    return std::vector<std::uint8_t>(bytes.begin(), bytes.end());
  });
}

void OctomapBuilder::write_bt(const std::filesystem::path& path, const OctomapCut& cut) const {
  tree_->with(cut, [&](const CounterMap& counters, OctreeTiles& tiles) {
    io::write_file_atomically(path, BtEncoder(counters, tiles).file());
  });
}

void OctomapBuilder::write_ot(const std::filesystem::path& path, const OctomapCut& cut) const {
  tree_->with(cut, [&](const CounterMap& counters, OctreeTiles& tiles) {
    io::write_file_atomically(path, OtEncoder(counters, tiles).file());
  });
}

OctomapSize OctomapBuilder::size() const {
  tree_->follow();
  const CounterMap& counters = tree_->whole();
  OctomapSize size;
  for (std::size_t i = 0; i < counters.block_count(); ++i) {
    const std::size_t occupied = cells_in(counters.occupied(i));
    size.occupied += occupied;
    size.free += cells_in(counters.known(i)) - occupied;
  }
  size.nodes = tree_->with(
      {}, [](const CounterMap& all, OctreeTiles& tiles) { return BtEncoder(all, tiles).nodes(); });
  return size;
}

Occupancy OctomapBuilder::at(const Eigen::Vector3d& point_map) const {
  if (!in_lattice(point_map, tree_->rules.resolution_m)) return Occupancy::kUnknown;
  tree_->follow();
  switch (tree_->whole().at(voxel_at(point_map, tree_->rules.resolution_m))) {
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
