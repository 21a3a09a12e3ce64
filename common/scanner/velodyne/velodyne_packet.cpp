#include "voxlist/scanner/velodyne/velodyne_packet.h"

#include <array>
#include <optional>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"

namespace voxlist::scanner {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kBlocks = 12, kBlockBytes = 100, kHeadBytes = 4, kReturnBytes = 3;
constexpr std::size_t kStampAt = kBlocks * kBlockBytes, kModeAt = 1204, kModelAt = 1205;
constexpr std::size_t kReturnsOfBlock = 32;
constexpr std::uint8_t kDualReturns = 0x39;
constexpr double kUnit_m = 0.002;  // of ranges
constexpr int kTurn_cdeg = 36'000;

// How a laser fires.
struct Model {
  std::uint8_t number;        // in its packets
  std::size_t lasers;         // of one firing
  double firing_us, step_us;  // from one firing to the next, from one laser to the next
  std::array<double, 32> elevations_deg;
  std::array<double, 32> lifts_mm;  // of the beams' starts
  std::array<std::uint8_t, 32> rings;
};

constexpr Model with_rings(Model model) {
  for (std::size_t i = 0; i < model.lasers; ++i) {
    int below = 0;
    for (std::size_t j = 0; j < model.lasers; ++j)
      below += model.elevations_deg[j] < model.elevations_deg[i] ? 1 : 0;
    model.rings[i] = static_cast<std::uint8_t>(below);
  }
  return model;
}

constexpr Model kVlp16 =
    with_rings({.number = 0x22,
                .lasers = 16,
                .firing_us = 55.296,
                .step_us = 2.304,
                .elevations_deg = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15},
                .lifts_mm = {11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1, 5.1, -6.6, 3.7, -8.1, 2.2,
                             -9.7, 0.7, -11.2},
                .rings = {}});

constexpr Model kHdl32 =
    with_rings({.number = 0x21,
                .lasers = 32,
                .firing_us = 46.080,
                .step_us = 1.152,
                .elevations_deg = {-30.67, -9.33, -29.33, -8.00, -28.00, -6.67, -26.67, -5.33,
                                   -25.33, -4.00, -24.00, -2.67, -22.67, -1.33, -21.33, 0.00,
                                   -20.00, 1.33,  -18.67, 2.67,  -17.33, 4.00,  -16.00, 5.33,
                                   -14.67, 6.67,  -13.33, 8.00,  -12.00, 9.33,  -10.67, 10.67},
                .lifts_mm = {},
                .rings = {}});

int u16_at(Bytes bytes, std::size_t at) { return bytes[at] | bytes[at + 1] << 8; }

std::uint32_t u32_at(Bytes bytes, std::size_t at) {
  return static_cast<std::uint32_t>(u16_at(bytes, at)) |
         static_cast<std::uint32_t>(u16_at(bytes, at + 2)) << 16;
}

const Model* model_of(std::uint8_t number) {
  for (const Model* model : {&kVlp16, &kHdl32})
    if (model->number == number) return model;
  return nullptr;
}

int azimuth_of(Bytes payload, std::size_t block) {
  return u16_at(payload, block * kBlockBytes + 2);
}

bool is_whole(Bytes payload) {
  for (std::size_t block = 0; block < kBlocks; ++block)
    if (u16_at(payload, block * kBlockBytes) != 0xEEFF || azimuth_of(payload, block) >= kTurn_cdeg)
      return false;
  return true;
}

// A packet with what is the same for all of it.
struct Reader {
  Bytes payload;
  const Model& model;
  std::size_t step;  // 2: two blocks of the same firings, one for each return

  double block_us() const {
    return model.firing_us * static_cast<double>(kReturnsOfBlock / model.lasers);
  }

  // How far the laser turns from this block to the next one in time; in the last block as before.
  double turn_cdeg(std::size_t block) const {
    const std::size_t from = block + step < kBlocks ? block : block - step;
    const int turn = azimuth_of(payload, from + step) - azimuth_of(payload, from);
    return (turn + kTurn_cdeg) % kTurn_cdeg;
  }

  bool repeats(std::size_t block, std::size_t i) const {
    if (step == 1 || block % 2 == 0) return false;
    const std::size_t at = kHeadBytes + i * kReturnBytes;
    return u16_at(payload, block * kBlockBytes + at) ==
           u16_at(payload, (block - 1) * kBlockBytes + at);
  }

  std::optional<VelodyneReturn> read(std::size_t block, std::size_t i) const {
    const std::size_t at = block * kBlockBytes + kHeadBytes + i * kReturnBytes;
    const double range_m = kUnit_m * u16_at(payload, at);
    if (range_m == 0.0 || repeats(block, i)) return std::nullopt;
    const std::size_t laser = i % model.lasers;
    const double in_block_us = model.firing_us * static_cast<double>(i / model.lasers) +
                               model.step_us * static_cast<double>(laser);
    const double azimuth_cdeg =
        azimuth_of(payload, block) + turn_cdeg(block) * in_block_us / block_us();
    const double azimuth_rad = 0.01 * azimuth_cdeg * kRadPerDeg;
    const double up_rad = model.elevations_deg[laser] * kRadPerDeg;
    const double flat_m = range_m * elementary::cos(up_rad);
    const Eigen::Vector3d point(flat_m * elementary::cos(azimuth_rad),
                                -flat_m * elementary::sin(azimuth_rad),
                                range_m * elementary::sin(up_rad) + 0.001 * model.lifts_mm[laser]);
    return VelodyneReturn{point.cast<float>(),
                          block_us() * static_cast<double>(block / step) + in_block_us,
                          model.rings[laser], payload[at + 2]};
  }
};

}  // namespace

VelodynePacket read_velodyne(Bytes payload) {
  VelodynePacket packet;
  if (payload.size() != kVelodyneBytes) return packet;
  packet.model = payload[kModelAt];
  packet.stamp_us = u32_at(payload, kStampAt);
  const Model* model = model_of(packet.model);
  packet.kind = !is_whole(payload) || packet.stamp_us >= kVelodyneHour_us ? VelodyneKind::kBroken
                : model == nullptr ? VelodyneKind::kUnknownModel
                                   : VelodyneKind::kData;
  if (packet.kind != VelodyneKind::kData) return packet;
  const Reader reader{payload, *model, payload[kModeAt] == kDualReturns ? 2U : 1U};
  packet.length_us = reader.block_us() * static_cast<double>(kBlocks / reader.step);
  for (std::size_t block = 0; block < kBlocks; ++block) {
    VelodyneBlock& to = packet.blocks.emplace_back();
    to.azimuth_cdeg = azimuth_of(payload, block);
    for (std::size_t i = 0; i < kReturnsOfBlock; ++i)
      if (const auto back = reader.read(block, i)) to.returns.push_back(*back);
  }
  return packet;
}

}  // namespace voxlist::scanner
