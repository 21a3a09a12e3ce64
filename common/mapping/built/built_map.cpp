#include "voxlist/mapping/built/built_map.h"

#include <bit>
#include <stdexcept>
#include <utility>

#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/cursor.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/built/checked_stream.h"
#include "voxlist/mapping/keyframe_format.h"
#include "voxlist/system/version.h"

namespace voxlist::mapping {
namespace {

constexpr std::uint64_t kMagic = 0x3130304c42584f56;  // "VOXBL001"
// A block's position and a mask: what it takes at least.
constexpr std::uint64_t kLeastBytesOfBlock = sizeof(Voxel) + 1;

class Hash {
 public:
  void add(std::uint64_t value) { hash_ = mixed(hash_ ^ value); }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = kMagic;
};

void add(const MapBuilderConfig& config, Hash& hash) {
  hash.add(config.min_range_m);
  hash.add(config.max_range_m);
  hash.add(std::uint64_t{config.carve});
  hash.add(std::uint64_t{config.count_free});
}

void add(const StampedPose3& pose, Hash& hash) {
  hash.add(static_cast<std::uint64_t>(pose.utime_us));
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) hash.add(pose.pose.matrix()(row, column));
}

Voxel checked(const Voxel& block) {
  constexpr std::int32_t kMost = kVoxelLimit / kBlockEdge;
  for (const std::int32_t at : {block.x, block.y, block.z})
    if (at < -kMost || at > kMost) throw io::FormatError("has a block outside of all maps");
  return block;
}

// Writes parts of a map.
class Writing {
 public:
  explicit Writing(CheckedWriter& out) : out_(out) {}

  void operator()(const VoxelMap& map) const {
    begin(map);
    for (std::size_t i = 0; i < map.block_count(); ++i) put(map.block_position(i), map.block(i));
  }

  void operator()(const CounterMap& map) const {
    begin(map);
    for (std::size_t i = 0; i < map.block_count(); ++i)
      put(map.block_position(i), std::span(map.block(i).planes.front().data(), kCounterWords));
  }

  static constexpr std::size_t kCounterWords = sizeof(CounterBlock) / sizeof(std::uint64_t);

 private:
  template <class Map>
  void begin(const Map& map) const {
    out_.put(map.resolution_m());
    out_.put(std::uint64_t{map.block_count()});
  }

  void put(const Voxel& at, std::span<const std::uint64_t> words) const {
    out_.put(at);
    out_.put_words(words);
    out_.end_item();
  }

  CheckedWriter& out_;
};

// Fills the empty parts of a map.
class Reading {
 public:
  explicit Reading(CheckedReader& in) : in_(in) {}

  void operator()(VoxelMap& map) const {
    fill(map, [&](const Voxel& at) {
      VoxelBlock bits;
      in_.take_words(bits);
      map.set_block(at, bits);
    });
  }

  void operator()(CounterMap& map) const {
    fill(map, [&](const Voxel& at) {
      CounterBlock& block = map.counters_at(at);
      in_.take_words(std::span(block.planes.front().data(), Writing::kCounterWords));
    });
  }

 private:
  template <class Map, class Take>
  void fill(Map& map, const Take& take) const {
    if (in_.take<double>() != map.resolution_m()) throw io::FormatError("has other voxels");
    const auto blocks = in_.take<std::uint64_t>();
    if (blocks > in_.size() / kLeastBytesOfBlock) throw io::FormatError("has too many blocks");
    map.reserve(blocks);
    for (std::uint64_t i = 0; i < blocks; ++i) take(checked(in_.take<Voxel>()));
  }

  CheckedReader& in_;
};

std::size_t read(const std::filesystem::path& file, const BuiltOf& of, MapBuilder& builder) {
  io::FileWindow window(file);
  CheckedReader in(window);
  if (in.take<std::uint64_t>() != kMagic) throw io::FormatError("is no map");
  const auto keyframes = in.take<std::uint64_t>();
  if (keyframes > of.poses.size() ||
      in.take<std::uint64_t>() != of.key(keyframes, builder.config()))
    throw io::FormatError("is of other keyframes");
  const auto first = of.poses.first(keyframes);
  builder.restore({first.begin(), first.end()}, Reading(in));
  in.end();
  return keyframes;
}

}  // namespace

std::uint64_t BuiltOf::key(std::size_t keyframes, const MapBuilderConfig& config) const {
  Hash hash;
  hash.add(std::uint64_t{checksum_of(version())});
  hash.add(static_cast<std::uint64_t>(map_id));
  add(config, hash);
  for (std::size_t i = 0; i < keyframes; ++i) {
    hash.add(std::uint64_t{places[i].checksum} << 32 ^ places[i].bytes);
    add(poses[i], hash);
  }
  return hash.value();
}

void write_built(const std::filesystem::path& folder, const BuiltOf& of,
                 const MapBuilder& builder) {
  io::AtomicFile file(folder / kBuiltFile);
  CheckedWriter out(file);
  out.put(kMagic);
  out.put(std::uint64_t{of.poses.size()});
  out.put(of.key(of.poses.size(), builder.config()));
  builder.visit_built(Writing(out));
  out.finish();
  file.commit();
}

std::size_t read_built(const std::filesystem::path& folder, const BuiltOf& of,
                       MapBuilder& builder) try {
  if (!std::filesystem::exists(folder / kBuiltFile)) return 0;
  return read(folder / kBuiltFile, of, builder);
} catch (const std::runtime_error&) {
  builder.clear();
  return 0;
}

void add_stored(StoredKeyframes& keyframes, std::span<const StampedPose3> poses,
                MapBuilder& builder, const std::function<void()>& at_each) {
  for (std::size_t i = builder.poses().size(); i < poses.size(); ++i) {
    at_each();
    auto keyframe = keyframes.read(i).value_or(Keyframe{});
    keyframe.cloud.utime_us = poses[i].utime_us;
    keyframe.T_map_base = poses[i].pose;
    builder.add(std::move(keyframe));
  }
}

}  // namespace voxlist::mapping
