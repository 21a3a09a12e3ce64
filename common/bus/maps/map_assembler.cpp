#include <algorithm>

#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/bus/maps/map_faults.h"

namespace voxlist::bus {
namespace {

// Increments that may wait behind a whole map which is still coming in: six seconds at ten clouds a
// second.
constexpr std::size_t kMaxAssemblies = 64;

// Blocks that all of them may hold together: as many as one whole map.
constexpr std::size_t kMaxPendingBlocks = std::size_t{kMaxChunks} * kBlocksPerChunk;

// A change of more chunks than this, 5 MB, stays packed until it is applied.
constexpr std::size_t kUnpackedChunks = 64;

// Farthest (m) that an increment lies from the map that it adds to: a cloud reaches 1 km, and
// begins in the map.
constexpr double kMaxGap_m = 2'000.0;

MapResolution resolution_of(const map_update_t& m) {
  return {m.resolution_m, m.passed_resolution_m};
}

// Calls visit(corner of the block in metres).
template <class Visit>
void for_each_corner(const std::vector<voxel_block_t>& blocks, double resolution_m, Visit visit) {
  for (const voxel_block_t& b : blocks)
    visit(Eigen::Vector3d(8.0 * resolution_m * Eigen::Vector3d(b.x, b.y, b.z)));
}

MapChange header_of(const map_update_t& m) {
  return {m.utime,          m.map_id, m.version, m.base_version,
          resolution_of(m), {},       m.moves,   {m.moved[0], m.moved[1], m.moved[2]},
          m.edits};
}

bool leads_to_the_same(const MapChange& a, const MapChange& b) {
  return a.map_id == b.map_id && a.version == b.version && a.base_version == b.base_version &&
         a.moves == b.moves && a.edits == b.edits;
}

void append(const MapBlocks& more, MapBlocks& blocks) {
  blocks.occupied.insert(blocks.occupied.end(), more.occupied.begin(), more.occupied.end());
  blocks.passed.insert(blocks.passed.end(), more.passed.begin(), more.passed.end());
}

}  // namespace

std::vector<MapChange> MapAssembler::add(const map_update_t& message) {
  const auto refuse = [this](const char* why) {
    ++counters_[why];
    return std::vector<MapChange>{};
  };
  if (const MapFault fault = fault_of(message); fault != MapFault::kNone)
    return refuse(name(fault));
  if (is_older(header_of(message))) return refuse("older");
  if (is_far_from_held(message)) return refuse(name(MapFault::kFarBlock));
  Assembly* assembly = assembly_of(message);
  if (assembly == nullptr) return refuse(name(MapFault::kChunk));
  put(message, *assembly);
  std::vector<MapChange> ready = take_ready();
  bound_memory();
  return ready;
}

void MapAssembler::forget() {
  held_.reset();
  assemblies_.clear();
  pending_blocks_ = 0;
}

// Versions decide, not times: the mapper's time is that of the last cloud, and clouds come from
// whoever publishes them.
bool MapAssembler::is_older(const MapChange& change) const {
  if (!held_ || held_->map_id != change.map_id) return false;
  const bool nothing_changed = change.base_version == change.version;
  return change.version < held_->version || (change.version == held_->version && !nothing_changed);
}

bool MapAssembler::is_far_from_held(const map_update_t& message) const {
  if (!held_ || message.base_version == kWholeMap) return false;
  bool far = false;
  const auto look = [&](const Eigen::Vector3d& corner) {
    far |= box_.exteriorDistance(corner) > kMaxGap_m;
  };
  for_each_corner(message.blocks, message.resolution_m, look);
  for_each_corner(message.passed_blocks, message.passed_resolution_m, look);
  return far;
}

bool MapAssembler::builds_on_held(const MapChange& change) const {
  if (change.is_whole()) return true;
  return held_ && held_->map_id == change.map_id && held_->version == change.base_version &&
         held_->resolution == change.resolution;
}

// The assembly that the message belongs to, perhaps a new one; nullptr: it contradicts its other
// chunks.
MapAssembler::Assembly* MapAssembler::assembly_of(const map_update_t& message) {
  const MapChange header = header_of(message);
  const auto found = std::ranges::find_if(
      assemblies_, [&](const Assembly& a) { return leads_to_the_same(a.change, header); });
  if (found == assemblies_.end()) {
    Assembly& fresh = assemblies_.emplace_back();
    fresh.change = header;
    fresh.chunks.resize(static_cast<std::size_t>(message.n_chunks));
    fresh.missing = message.n_chunks;
    return &fresh;
  }
  const bool agrees = std::ssize(found->chunks) == message.n_chunks &&
                      found->change.resolution == header.resolution;
  if (!agrees) return nullptr;
  found->change.utime_us = header.utime_us;
  return &*found;
}

void MapAssembler::put(const map_update_t& message, Assembly& assembly) {
  auto& chunk = assembly.chunks[static_cast<std::size_t>(message.chunk)];
  if (chunk) {
    ++counters_["duplicate"];
    return;
  }
  chunk.emplace(MapBlocks{message.blocks, message.passed_blocks});
  --assembly.missing;
  pending_blocks_ += chunk->size();
}

std::vector<MapChange> MapAssembler::take_ready() {
  std::vector<MapChange> changes;
  const auto is_ready = [&](const Assembly& assembly) {
    return assembly.missing == 0 && builds_on_held(assembly.change);
  };
  for (auto ready = std::ranges::find_if(assemblies_, is_ready); ready != assemblies_.end();
       ready = std::ranges::find_if(assemblies_, is_ready)) {
    changes.push_back(take(ready));
    abandon_useless();
  }
  return changes;
}

MapChange MapAssembler::take(std::list<Assembly>::iterator ready) {
  MapChange change = std::move(ready->change);
  const bool is_large = ready->chunks.size() > kUnpackedChunks;
  for (auto& chunk : ready->chunks) {
    pending_blocks_ -= chunk->size();
    is_large ? change.packed.push_back(std::move(*chunk))
             : append(chunk->unpacked(), change.blocks);
  }
  assemblies_.erase(ready);
  hold(change);
  return change;
}

void MapAssembler::hold(const MapChange& change) {
  held_ = Held{change.utime_us, change.map_id, change.version, change.resolution};
  if (change.is_whole()) box_ = Eigen::AlignedBox3d(Eigen::Vector3d::Zero().eval());
  const auto extend = [this](const Eigen::Vector3d& corner) { box_.extend(corner); };
  change.for_each_part([&](const MapBlocks& blocks) {
    for_each_corner(blocks.occupied, change.resolution.occupied_m, extend);
    for_each_corner(blocks.passed, change.resolution.passed_m, extend);
  });
}

void MapAssembler::abandon(std::list<Assembly>::iterator assembly) {
  for (const auto& chunk : assembly->chunks) {
    if (chunk) pending_blocks_ -= chunk->size();
  }
  assemblies_.erase(assembly);
  ++counters_["abandoned"];
}

void MapAssembler::abandon_useless() {
  const auto is_useless = [&](const Assembly& assembly) { return is_older(assembly.change); };
  for (auto useless = std::ranges::find_if(assemblies_, is_useless); useless != assemblies_.end();
       useless = std::ranges::find_if(assemblies_, is_useless)) {
    abandon(useless);
  }
}

// Drops the oldest first: what it misses then shows in needs_request().
void MapAssembler::bound_memory() {
  while (assemblies_.size() > kMaxAssemblies || pending_blocks_ > kMaxPendingBlocks) {
    abandon(assemblies_.begin());
  }
}

}  // namespace voxlist::bus
