#include "voxlist/planning/octomap.h"

#include <octomap/OcTree.h>

#include <sstream>
#include <string>

#include "voxlist/geometry/range.h"
#include "voxlist/io/files/atomic_file.h"

namespace voxlist::planning {
namespace {

octomap::point3d to_octomap(const Eigen::Vector3d& p) {
  const Eigen::Vector3f f = p.cast<float>();
  return {f.x(), f.y(), f.z()};
}

// Writes as OctoMap's writeBinary does, without the line that it prints to the console each time.
std::string to_bt(octomap::OcTree copy) {
  copy.toMaxLikelihood();
  copy.prune();
  std::ostringstream out;
  out << "# Octomap OcTree binary file\n"
         "# (feel free to add / change comments, but leave the first line as it is!)\n"
         "#\nid OcTree\nsize "
      << copy.size() << "\nres " << copy.getResolution() << "\ndata\n";
  copy.writeBinaryData(out);
  return out.str();
}

// Rays between two looks at whether to stop: of 100 m, through voxels of 0.1 m, they take 20 ms.
constexpr std::size_t kRaysAtOnce = 256;

// The voxels that one cloud's rays pass through and end in.
struct RayCells {
  octomap::KeySet passed, hit;

  void add(const octomap::OcTree& octree, const octomap::point3d& origin,
           const octomap::point3d& end) {
    octomap::OcTreeKey first, last;
    if (!octree.coordToKeyChecked(origin, first) || !octree.coordToKeyChecked(end, last)) return;
    octree.computeRayKeys(origin, end, keys_);
    passed.insert(keys_.begin(), keys_.end());
    hit.insert(last);
  }

 private:
  octomap::KeyRay keys_;
};

}  // namespace

struct OctomapBuilder::Tree {
  explicit Tree(const OctomapConfig& wanted) : octree(wanted.resolution_m), config(wanted) {
    octree.setProbHit(wanted.hit_probability);
    octree.setProbMiss(wanted.miss_probability);
  }

  octomap::OcTree octree;
  const OctomapConfig config;
};

OctomapBuilder::OctomapBuilder(const OctomapConfig& config)
    : tree_(std::make_unique<Tree>(config)) {}
OctomapBuilder::~OctomapBuilder() = default;
OctomapBuilder::OctomapBuilder(OctomapBuilder&&) noexcept = default;
OctomapBuilder& OctomapBuilder::operator=(OctomapBuilder&&) noexcept = default;

bool OctomapBuilder::insert(const Pose3& T_map_base, const Cloud& cloud_base,
                            const std::function<bool()>& stopped) {
  octomap::OcTree& octree = tree_->octree;
  const OctomapConfig& config = tree_->config;
  RayCells cells;
  for (std::size_t i = 0; i < cloud_base.points.size(); ++i) {
    if (i % kRaysAtOnce == 0 && stopped && stopped()) return false;
    if (!is_within(cloud_base, i, config.min_range_m, config.max_range_m)) continue;
    cells.add(octree, to_octomap(T_map_base * cloud_base.origin(i).cast<double>()),
              to_octomap(T_map_base * cloud_base.points[i].cast<double>()));
  }
  for (const octomap::OcTreeKey& key : cells.passed)
    if (cells.hit.count(key) == 0) octree.updateNode(key, false);
  for (const octomap::OcTreeKey& key : cells.hit) octree.updateNode(key, true);
  return true;
}

std::vector<std::uint8_t> OctomapBuilder::binary() const {
  const std::string bytes = to_bt(tree_->octree);
  return {bytes.begin(), bytes.end()};
}

void OctomapBuilder::write_bt(const std::filesystem::path& path) const {
  io::write_file_atomically(path, to_bt(tree_->octree));
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
