#include <algorithm>
#include <cmath>

#include "voxlist/bus/convert.h"
#include "voxlist/bus/map_chunks.h"

namespace voxlist::bus {
namespace {

// Increments that may wait behind a whole map which is still coming in: six seconds at ten clouds a
// second.
constexpr std::size_t kMaxAssemblies = 64;

// Blocks that all of them may hold together: as many as one whole map.
constexpr std::size_t kMaxPendingBlocks = std::size_t{kMaxChunks} * kBlocksPerChunk;

// A message that is older than the map by up to this (us) came late on its way; an even older one
// belongs to a recording that started anew.
constexpr std::int64_t kLateness_us = 10'000'000;

// Voxel edges (m) that a map may have: a millimetre is finer than any laser, ten metres no map.
constexpr double kMinResolution_m = 1e-3;
constexpr double kMaxResolution_m = 10.0;

MapResolution resolution_of(const map_update_t& m) {
  return {m.resolution_m, m.passed_resolution_m};
}

bool is_sane_coordinate(std::int32_t c) { return std::abs(std::int64_t{c}) < kMaxBlockCoordinate; }

bool is_sane_block(const voxel_block_t& block) {
  return is_sane_coordinate(block.x) && is_sane_coordinate(block.y) && is_sane_coordinate(block.z);
}

// Written so that NaN fails.
bool is_sane(const MapResolution& resolution) {
  return resolution.occupied_m >= kMinResolution_m && resolution.passed_m <= kMaxResolution_m &&
         resolution.occupied_m <= resolution.passed_m;
}

bool is_sane(const map_update_t& m) {
  const bool versions =
      m.version >= 0 && m.base_version >= kWholeMap && m.base_version <= m.version;
  const bool chunks =
      m.n_chunks >= 1 && m.n_chunks <= kMaxChunks && m.chunk >= 0 && m.chunk < m.n_chunks;
  const bool nothing_changed = m.base_version == m.version;
  const std::ptrdiff_t n_blocks = std::ssize(m.blocks) + std::ssize(m.passed_blocks);
  return is_sane_utime(m.utime) && versions && chunks && is_sane(resolution_of(m)) &&
         n_blocks <= (nothing_changed ? 0 : kBlocksPerChunk) &&
         std::ranges::all_of(m.blocks, is_sane_block) &&
         std::ranges::all_of(m.passed_blocks, is_sane_block);
}

MapChange header_of(const map_update_t& m) {
  return {m.utime, m.map_id, m.version, m.base_version, resolution_of(m), {}};
}

bool same_header(const MapChange& a, const MapChange& b) {
  return a.utime_us == b.utime_us && a.map_id == b.map_id && a.version == b.version &&
         a.base_version == b.base_version;
}

void append(const std::vector<voxel_block_t>& more, std::vector<voxel_block_t>& blocks) {
  blocks.insert(blocks.end(), more.begin(), more.end());
}

bool came_late(std::int64_t utime_us, std::int64_t newest_us) {
  return utime_us < newest_us && newest_us - utime_us <= kLateness_us;
}

}  // namespace

std::vector<MapChange> MapAssembler::add(const map_update_t& message) {
  const MapChange header = header_of(message);
  if (!is_sane(message)) {
    ++counters_["bad_chunk"];
    return {};
  }
  if (is_stale(header)) {
    ++counters_["stale"];
    return {};
  }
  const bool late =
      newest_ && newest_->map_id == header.map_id && came_late(header.utime_us, newest_->utime_us);
  if (!late) newest_ = header;
  Assembly* assembly = assembly_of(message);
  if (assembly == nullptr) {
    ++counters_["bad_chunk"];
    return {};
  }
  put(message, *assembly);
  std::vector<MapChange> ready = take_ready();
  bound_memory();
  return ready;
}

bool MapAssembler::needs_request() const {
  if (!held_) return true;
  if (newest_->map_id == held_->map_id && newest_->version == held_->version) return false;
  const bool coming = std::ranges::any_of(assemblies_, [&](const Assembly& assembly) {
    return same_header(assembly.change, *newest_) && builds_on_held(assembly.change);
  });
  return !coming;
}

bool MapAssembler::is_stale(const MapChange& change) const {
  if (!held_ || held_->map_id != change.map_id) return false;
  if (came_late(change.utime_us, held_->utime_us)) return true;
  return change.utime_us == held_->utime_us && change.version <= held_->version;
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
      assemblies_, [&](const Assembly& assembly) { return same_header(assembly.change, header); });
  if (found == assemblies_.end()) {
    Assembly& fresh = assemblies_.emplace_back();
    fresh.change = header;
    fresh.chunks.resize(static_cast<std::size_t>(message.n_chunks));
    fresh.missing = message.n_chunks;
    return &fresh;
  }
  const bool agrees = std::ssize(found->chunks) == message.n_chunks &&
                      found->change.resolution == header.resolution;
  return agrees ? &*found : nullptr;
}

void MapAssembler::put(const map_update_t& message, Assembly& assembly) {
  auto& chunk = assembly.chunks[static_cast<std::size_t>(message.chunk)];
  if (chunk) {
    ++counters_["duplicate"];
    return;
  }
  chunk = MapBlocks{message.blocks, message.passed_blocks};
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
  for (const auto& chunk : ready->chunks) {
    append(chunk->occupied, change.blocks.occupied);
    append(chunk->passed, change.blocks.passed);
  }
  pending_blocks_ -= change.blocks.size();
  assemblies_.erase(ready);
  held_ = Held{change.utime_us, change.map_id, change.version, change.resolution};
  return change;
}

void MapAssembler::abandon(std::list<Assembly>::iterator assembly) {
  for (const auto& chunk : assembly->chunks) {
    if (chunk) pending_blocks_ -= chunk->size();
  }
  assemblies_.erase(assembly);
  ++counters_["abandoned"];
}

void MapAssembler::abandon_useless() {
  const auto is_useless = [&](const Assembly& assembly) { return is_stale(assembly.change); };
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
