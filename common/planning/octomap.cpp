#include "voxlist/planning/octomap.h"

#include <octomap/OcTree.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <string>

#include "voxlist/geometry/range.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/planning/bt_encoder.h"

namespace voxlist::planning {
namespace {

octomap::point3d to_octomap(const Eigen::Vector3d& p) {
  const Eigen::Vector3f f = p.cast<float>();
  return {f.x(), f.y(), f.z()};
}

// Voxels that one cloud's rays may pass. A scan of a hall of 30 x 60 m passes up to 750,000 at 0.1
// m. Scattered over a sphere of 99 m, as of 3000 points there, a million take 180 MB of the tree;
// all 4.4 million took 700 MB and 7 s.
constexpr std::size_t kMostPassed = 1'000'000;

// Rays, and voxels, between two looks at whether to stop: of 100 m, through voxels of 0.1 m, the
// rays take 20 ms; so do the voxels.
constexpr std::size_t kRaysAtOnce = 256;
constexpr std::size_t kVoxelsAtOnce = 8192;

// Voxels that all rays are followed for, one after the other, before any is followed farther.
constexpr int kShell = 32;

using Stopped = std::function<bool()>;

struct Ray {
  octomap::point3d origin, end;
};

// The voxels that one cloud's rays pass through and end in.
class RayCells {
 public:
  RayCells(const octomap::OcTree& octree, const Stopped& stopped)
      : octree_(octree), stopped_(stopped) {}

  void add(const Ray& ray) {
    octomap::OcTreeKey first, last;
    if (!octree_.coordToKeyChecked(ray.origin, first) || !octree_.coordToKeyChecked(ray.end, last))
      return;
    rays_.push_back(ray);
    hit.insert(last);
  }

  // False when it was stopped.
  bool follow() {
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (stop_at(i)) return false;
      pass(rays_[i].origin, rays_[i].end);
      if (passed.size() > kMostPassed) return follow_by_shells();
    }
    return true;
  }

  octomap::KeySet passed, hit;
  double reach_m = std::numeric_limits<double>::infinity();

 private:
  bool stop_at(std::size_t i) const { return i % kRaysAtOnce == 0 && stopped_ && stopped_(); }

  void pass(const octomap::point3d& from, const octomap::point3d& to) {
    if (!octree_.computeRayKeys(from, to, keys_)) return;
    passed.insert(keys_.begin(), keys_.end());
  }

  // All rays as far as the voxels last, so that none is favoured.
  bool follow_by_shells() {
    passed.clear();
    const double step_m = kShell * octree_.getResolution();
    for (reach_m = 0.0; passed.size() <= kMostPassed; reach_m += step_m) {
      for (std::size_t i = 0; i < rays_.size() && passed.size() <= kMostPassed; ++i) {
        if (stop_at(i)) return false;
        pass_between(rays_[i], reach_m, reach_m + step_m);
      }
    }
    return true;
  }

  void pass_between(const Ray& ray, double from_m, double to_m) {
    const octomap::point3d way = ray.end - ray.origin;
    const double length_m = way.norm();
    if (from_m >= length_m) return;
    const auto at = [&](double m) { return ray.origin + way * static_cast<float>(m / length_m); };
    pass(at(from_m), to_m < length_m ? at(to_m) : ray.end);
  }

  const octomap::OcTree& octree_;
  const Stopped& stopped_;
  std::vector<Ray> rays_;
  octomap::KeyRay keys_;
};

}  // namespace

struct OctomapBuilder::Tree {
  explicit Tree(const OctomapConfig& wanted) : octree(wanted.resolution_m), config(wanted) {
    octree.setProbHit(wanted.hit_probability);
    octree.setProbMiss(wanted.miss_probability);
    octree.enableChangeDetection(true);
  }

  // False when it was stopped: what of the cloud is in stays in.
  bool update(const RayCells& cells, const Stopped& stopped) {
    std::size_t updated = 0;
    const auto put = [&](const octomap::OcTreeKey& key, bool occupied) {
      if (updated++ % kVoxelsAtOnce == 0 && stopped && stopped()) return false;
      octree.updateNode(key, occupied);
      return true;
    };
    for (const octomap::OcTreeKey& key : cells.hit)
      if (!put(key, true)) return false;
    for (const octomap::OcTreeKey& key : cells.passed)
      if (cells.hit.count(key) == 0 && !put(key, false)) return false;
    return true;
  }

  // Most updates confirm what was known: only what became free or occupied is encoded anew.
  void note_changes() {
    for (auto key = octree.changedKeysBegin(); key != octree.changedKeysEnd(); ++key)
      encoder.forget(key->first);
    octree.resetChangeDetection();
  }

  octomap::OcTree octree;
  BtEncoder encoder;
  const OctomapConfig config;
  double reach_m = std::numeric_limits<double>::infinity();
};

OctomapBuilder::OctomapBuilder(const OctomapConfig& config)
    : tree_(std::make_unique<Tree>(config)) {}
OctomapBuilder::~OctomapBuilder() = default;
OctomapBuilder::OctomapBuilder(OctomapBuilder&&) noexcept = default;
OctomapBuilder& OctomapBuilder::operator=(OctomapBuilder&&) noexcept = default;

bool OctomapBuilder::insert(const Pose3& T_map_base, const Cloud& cloud_base,
                            const std::function<bool()>& stopped) {
  const OctomapConfig& config = tree_->config;
  RayCells cells(tree_->octree, stopped);
  for (std::size_t i = 0; i < cloud_base.points.size(); ++i) {
    if (!is_within(cloud_base, i, config.min_range_m, config.max_range_m)) continue;
    cells.add({to_octomap(T_map_base * cloud_base.origin(i).cast<double>()),
               to_octomap(T_map_base * cloud_base.points[i].cast<double>())});
  }
  if (!cells.follow()) return false;
  tree_->reach_m = std::min(tree_->reach_m, cells.reach_m);
  const bool whole = tree_->update(cells, stopped);
  tree_->note_changes();
  return whole;
}

double OctomapBuilder::reach_m() const { return tree_->reach_m; }

std::vector<std::uint8_t> OctomapBuilder::binary() const {
  const std::string bytes = tree_->encoder.encode(tree_->octree);
  return {bytes.begin(), bytes.end()};
}

void OctomapBuilder::write_bt(const std::filesystem::path& path) const {
  io::write_file_atomically(path, tree_->encoder.encode(tree_->octree));
}

void OctomapBuilder::write_ot(const std::filesystem::path& path) const {
  std::ostringstream out;
  tree_->octree.write(out);
  io::write_file_atomically(path, out.str());
}

OctomapSize OctomapBuilder::size() const {
  const octomap::OcTree& octree = tree_->octree;
  OctomapSize size;
  size.nodes = octree.size();
  for (auto leaf = octree.begin_leafs(); leaf != octree.end_leafs(); ++leaf) {
    const std::size_t edge = std::size_t{1} << (octree.getTreeDepth() - leaf.getDepth());
    (octree.isNodeOccupied(*leaf) ? size.occupied : size.free) += edge * edge * edge;
  }
  return size;
}

Occupancy OctomapBuilder::at(const Eigen::Vector3d& point_map) const {
  const octomap::OcTreeNode* node = tree_->octree.search(to_octomap(point_map));
  if (node == nullptr) return Occupancy::kUnknown;
  return tree_->octree.isNodeOccupied(node) ? Occupancy::kOccupied : Occupancy::kFree;
}

}  // namespace voxlist::planning
