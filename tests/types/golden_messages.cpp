// Writes messages of every type, one line each, "TYPE HEX": an empty one, then random ones, the
// same at every run. Programs in other languages read them and write them again.
#include <cstdio>

#include "tests/bus/filler.h"

namespace voxlist {
namespace {

constexpr int kRandomMessages = 20;

template <class M>
void write_line(const M& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, message.getEncodedSize());
  std::printf("%s ", M::getTypeName());
  for (const std::uint8_t byte : bytes) std::printf("%02x", byte);
  std::printf("\n");
}

template <class M>
void write_messages() {
  std::mt19937 random(1);
  write_line(M{});
  for (int i = 0; i < kRandomMessages; ++i) {
    M message{};
    bus::Filler(random, bus::Filler::Values::kPortable).fill(message);
    write_line(message);
  }
}

template <class... M>
void write_types() {
  (write_messages<M>(), ...);
}

}  // namespace
}  // namespace voxlist

int main() {
  using namespace voxlist;
  write_types<counter_t, edited_box_t, gauge_t, health_t, keyframe_t, localisation_t, map_edit_t,
              map_edits_t, map_octree_t, map_request_t, map_update_t, mirror_state_t,
              moving_obstacle_t, obstacles_t, pixel_map_t, planar_lidar_t, pointcloud_t,
              pose_mode_t, pose_hint_t, pose_t, rigid_transform_t, traversability_t,
              uncertain_pose_t, voxel_block_t>();
  counter_t umlaut{};
  umlaut.name = "Zähler";
  write_line(umlaut);
}
