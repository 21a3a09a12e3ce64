#include "voxlist/bus/maps/map_faults.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <voxlist/map_update_t.hpp>

#include "voxlist/bus/convert.h"
#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/system/memory.h"

namespace voxlist::bus {
namespace {

// Edges of voxels and of passed cells that a map may have (m): a laser measures no finer, and what
// is coarser than a door finds no place.
constexpr double kFinest_m = 0.01, kCoarsest_m = 1.0;

// Highest and lowest that a map reaches (m): more than any building or mine.
constexpr double kMapHeight_m = 2'000.0;

// Bytes that a block costs all in all: 76 on its way, as many while it waits, 90 in the map, and
// the rest in what is made of it for matching. An estimate.
constexpr std::int64_t kBytesPerBlock = 400;

bool is_resolution(double edge_m) { return edge_m >= kFinest_m && edge_m <= kCoarsest_m; }

bool versions_follow(const map_update_t& m) {
  const bool increment = m.version > 0 && m.base_version == m.version - 1;
  const bool whole = m.base_version == kWholeMap, nothing_changed = m.base_version == m.version;
  return m.version >= 0 && (whole || nothing_changed || increment) && m.moves >= 0 &&
         m.moves <= m.version && m.edits >= 0 && m.edits <= m.version - m.moves;
}

// A keyframe is moved within the map.
bool is_within_map(const double moved[3]) {
  return std::abs(moved[0]) < kMapReach_m && std::abs(moved[1]) < kMapReach_m &&
         std::isfinite(moved[2]);
}

// All chunks but the last are full, and a map without keyframes has no blocks.
bool chunks_fit(const map_update_t& m) {
  const std::ptrdiff_t n_blocks = std::ssize(m.blocks) + std::ssize(m.passed_blocks);
  const bool empty = m.version == 0 || m.base_version == m.version;
  const bool last = m.chunk == m.n_chunks - 1;
  return m.n_chunks >= 1 && m.n_chunks <= (empty ? 1 : kMaxChunks) && m.chunk >= 0 &&
         m.chunk < m.n_chunks && n_blocks <= (empty ? 0 : kBlocksPerChunk) &&
         (last || n_blocks == kBlocksPerChunk);
}

bool are_near(const std::vector<voxel_block_t>& blocks, double resolution_m) {
  const double edge_m = 8.0 * resolution_m;
  const auto reach = std::min(kMapReach_m / edge_m, double{kMaxBlockCoordinate});
  const auto height = std::min(kMapHeight_m / edge_m, double{kMaxBlockCoordinate});
  return std::ranges::all_of(blocks, [&](const voxel_block_t& b) {
    return std::abs(double(b.x)) < reach && std::abs(double(b.y)) < reach &&
           std::abs(double(b.z)) < height;
  });
}

}  // namespace

bool fits_memory(std::int64_t blocks, std::int64_t machine_bytes) {
  return blocks * kBytesPerBlock <= machine_bytes / 2;
}

MapFault fault_of(const map_update_t& m) {
  if (!is_sane_utime(m.utime)) return MapFault::kTime;
  if (!versions_follow(m) || !is_within_map(m.moved)) return MapFault::kVersion;
  if (!chunks_fit(m)) return MapFault::kChunk;
  if (!is_resolution(m.resolution_m) || !is_resolution(m.passed_resolution_m) ||
      m.passed_resolution_m < m.resolution_m)
    return MapFault::kResolution;
  if (!are_near(m.blocks, m.resolution_m) || !are_near(m.passed_blocks, m.passed_resolution_m))
    return MapFault::kFarBlock;
  const bool fits =
      fits_memory(std::int64_t{m.n_chunks - 1} * kBlocksPerChunk, memory_of_machine());
  return fits ? MapFault::kNone : MapFault::kTooLarge;
}

const char* name(MapFault fault) {
  switch (fault) {
    case MapFault::kTime:
      return "bad_utime";
    case MapFault::kVersion:
      return "bad_version";
    case MapFault::kChunk:
      return "bad_chunk";
    case MapFault::kResolution:
      return "bad_resolution";
    case MapFault::kFarBlock:
      return "far_block";
    case MapFault::kTooLarge:
      return "too_large";
    case MapFault::kNone:
      break;
  }
  return "";
}

const char* sentence(MapFault fault) {
  switch (fault) {
    case MapFault::kTime:
      return "has a utime that is no microseconds";
    case MapFault::kVersion:
      return "has versions that do not follow from each other";
    case MapFault::kChunk:
      return "has numbers of chunks or blocks that no mapper makes";
    case MapFault::kResolution:
      return "has voxels of a size that no map has";
    case MapFault::kFarBlock:
      return "has blocks kilometres away";
    case MapFault::kTooLarge:
      return "is of a map that does not fit this machine's memory";
    case MapFault::kNone:
      break;
  }
  return "";
}

}  // namespace voxlist::bus
