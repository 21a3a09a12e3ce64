#include "tests/bus/forge.h"

#include <array>
#include <bit>
#include <functional>
#include <voxlist/health_t.hpp>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_octree_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/bus/channels.h"
#include "voxlist/bus/wire.h"

namespace voxlist::bus {
namespace {

// Random content for each type. Half of the numbers are small ones that a service would believe,
// the others random bits: NaN, infinity and the extremes come up.
class Filler {
 public:
  explicit Filler(std::mt19937& random) : random_(random) {}

  void fill(std::int64_t& v) { v = static_cast<std::int64_t>(small() ? random_() % 4 : bits64()); }
  void fill(std::int32_t& v) { v = static_cast<std::int32_t>(small() ? random_() % 4 : random_()); }
  void fill(std::int8_t& v) { v = static_cast<std::int8_t>(random_()); }
  void fill(std::uint8_t& v) { v = static_cast<std::uint8_t>(random_()); }

  void fill(float& v) {
    v = small() ? static_cast<float>(random_() % 5) / 4.0F
                : std::bit_cast<float>(static_cast<std::uint32_t>(random_()));
  }

  void fill(double& v) {
    v = small() ? static_cast<double>(random_() % 5) / 4.0 : std::bit_cast<double>(bits64());
  }

  void fill(std::string& text) {
    text.resize(random_() % 12);
    for (char& c : text) c = static_cast<char>('!' + random_() % 90);
  }

  template <class T, std::size_t n>
  void fill(T (&values)[n]) {
    for (T& v : values) fill(v);
  }

  template <class T>
  void fill(std::vector<T>& values) {
    for (T& v : values) fill(v);
  }

  template <class T>
  void list(std::int32_t& count, std::vector<T>& values) {
    count = static_cast<std::int32_t>(random_() % 9);
    values.resize(static_cast<std::size_t>(count));
    fill(values);
  }

  void rows(std::size_t count, std::size_t columns, std::vector<std::vector<float>>& rows) {
    rows.assign(count, std::vector<float>(columns));
    fill(rows);
  }

  void fill(counter_t& m) { fill_all(m.name, m.count); }
  void fill(pose_mode_t& m) { fill_all(m.pose, m.covariance, m.overlap, m.probability); }
  void fill(voxel_block_t& m) { fill_all(m.x, m.y, m.z, m.bits); }
  void fill(map_request_t& m) { fill_all(m.utime, m.want, m.first); }
  void fill(pose_t& m) { fill_all(m.utime, m.pos, m.vel, m.orientation, m.rotation_rate, m.accel); }

  void fill(health_t& m) {
    fill_all(m.utime, m.service, m.pid, m.state, m.message);
    list(m.n_counters, m.counters);
    fill_all(m.latency_p50_ms, m.latency_p99_ms, m.latency_max_ms);
  }

  void fill(localisation_t& m) {
    fill_all(m.utime, m.map_id, m.map_version, m.state, m.significance_log10, m.confidence);
    list(m.n_modes, m.modes);
    fill_all(m.certified, m.searched_whole_map, m.poses_examined, m.elapsed_us);
  }

  void fill(map_octree_t& m) {
    fill_all(m.utime, m.map_id, m.view_id, m.transform);
    list(m.num_bytes, m.data);
  }

  void fill(map_update_t& m) {
    fill_all(m.utime, m.map_id, m.version, m.base_version, m.chunk, m.n_chunks, m.resolution_m,
             m.passed_resolution_m);
    list(m.n_blocks, m.blocks);
    list(m.n_passed_blocks, m.passed_blocks);
  }

  void fill(keyframe_t& m) {
    fill_all(m.utime, m.map_id, m.index, m.trans, m.quat);
    m.n_points = small_count();
    m.n_origins = small_count();
    rows(static_cast<std::size_t>(m.n_points), 3, m.points);
    rows(static_cast<std::size_t>(m.n_origins), 3, m.origins);
  }

  void fill(obstacles_t& m) {
    fill_all(m.utime, m.min_height_m, m.max_height_m, m.rad0, m.radstep);
    list(m.n_bearings, m.ranges_m);
    list(m.n_cells, m.types);
    rows(static_cast<std::size_t>(m.n_cells), 2, m.cells);
  }

  void fill(mirror_state_t& m) {
    fill_all(m.utime, m.state, m.angle_known, m.reason, m.angle_rad, m.rate_radps,
             m.half_revolutions, m.residual_rad, m.step_rad);
  }

  void fill(planar_lidar_t& m) {
    fill_all(m.utime, m.rad0, m.radstep);
    list(m.nranges, m.ranges);
    list(m.nintensities, m.intensities);
  }

  void fill(pointcloud_t& m) {
    fill_all(m.utime, m.seq, m.frame_id);
    m.n_points = small_count();
    rows(static_cast<std::size_t>(m.n_points), 3, m.points);
    list(m.n_channels, m.channel_names);
    rows(static_cast<std::size_t>(m.n_channels), static_cast<std::size_t>(m.n_points), m.channels);
  }

 private:
  template <class... T>
  void fill_all(T&... values) {
    (fill(values), ...);
  }

  bool small() { return random_() % 2 == 0; }
  std::int32_t small_count() { return static_cast<std::int32_t>(random_() % 9); }
  std::uint64_t bits64() { return std::uint64_t{random_()} << 32 | random_(); }

  std::mt19937& random_;
};

struct Kind {
  std::string channel;
  std::function<std::vector<std::uint8_t>(std::mt19937&)> whole;
};

template <class M>
Kind kind(Channel<M> channel) {
  return {channel.name, [](std::mt19937& random) {
            M message{};
            Filler(random).fill(message);
            std::vector<std::uint8_t> bytes;
            encode(message, bytes);
            return bytes;
          }};
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      kind(kCloud),        kind(kCloudSlice), kind(kOdometry), kind(kPose),       kind(kTruth),
      kind(kLocalisation), kind(kMapUpdate),  kind(kKeyframe), kind(kMapRequest), kind(kOctomap),
      kind(kObstacles),    kind(kLaser),      kind(kMirror),   kind(kHealth)};
  return all;
}

void write_u32(std::uint32_t value, std::size_t at, std::vector<std::uint8_t>& bytes) {
  for (std::size_t i = 0; i < 4; ++i)
    bytes[at + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

constexpr std::array<std::uint32_t, 12> kAbsurdLengths = {
    0xFFFFFFFF,  0x80000000, 0x7FFFFFFF, 0x20000000, 0x20000001, 0x15555556,
    100'000'000, 1'000'000,  65'536,     64,         1,          0};

}  // namespace

Forge::Forge(std::uint32_t seed) : random_(seed) {}

const std::vector<std::string>& Forge::channels() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Kind& kind : kinds()) all.push_back(kind.channel);
    return all;
  }();
  return names;
}

std::size_t Forge::below(std::size_t limit) { return limit == 0 ? 0 : random_() % limit; }

std::vector<std::uint8_t> Forge::whole(std::size_t channel) {
  return kinds()[channel].whole(random_);
}

Forgery Forge::next() {
  const std::size_t channel = made_++ % kinds().size();
  std::vector<std::uint8_t> bytes = whole(channel);
  switch (below(8)) {
    case 0:
      break;
    case 1:
      bytes.resize(below(bytes.size()));
      break;
    case 2:
      bytes.resize(bytes.size() + 1 + below(20), static_cast<std::uint8_t>(random_()));
      break;
    case 3:
      for (std::size_t n = 1 + below(8); n > 0; --n) {
        bytes[below(bytes.size())] ^= static_cast<std::uint8_t>(1 << below(8));
      }
      break;
    case 4:
    case 5:
      write_u32(kAbsurdLengths[below(kAbsurdLengths.size())], 8 + below(bytes.size() - 11), bytes);
      break;
    case 6:
      bytes = whole(below(kinds().size()));
      break;
    default: {
      // Noise, half of the time behind the right fingerprint.
      const std::size_t from = below(2) * 8;
      bytes.resize(from + below(200));
      for (std::size_t i = from; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::uint8_t>(random_());
    }
  }
  return {kinds()[channel].channel, std::move(bytes)};
}

}  // namespace voxlist::bus
