#include "voxlist/simulation/scanner/transmit_line.h"

#include <algorithm>
#include <cmath>

namespace voxlist::simulation {
namespace {

constexpr double kBitsPerByte = 10.0;
// Most bytes that a fast listener makes of one byte of a slow sender: it has only so many edges.
constexpr double kMostBytesForOne = 8.0;

std::uint8_t any_byte(Random& random) { return static_cast<std::uint8_t>(random.bits() & 0xFF); }

}  // namespace

void TransmitLine::send(std::int64_t utime_us, std::span<const std::uint8_t> bytes, int baud,
                        const Damage& damage) {
  if (utime_us >= free_utime_us()) {
    base_utime_us_ = utime_us;
    free_us_ = 0.0;
  }
  const auto happens = [&](double probability) {
    return probability > 0.0 && random_.uniform(0.0, 1.0) < probability;
  };
  for (std::uint8_t byte : bytes) {
    if (happens(damage.corrupt)) byte = static_cast<std::uint8_t>(byte ^ 1u << random_.bits() % 8);
    put(byte, baud, happens(damage.drop));
    if (happens(damage.noise)) put(any_byte(random_), baud, false);
  }
}

void TransmitLine::put(std::uint8_t byte, int baud, bool lost) {
  free_us_ += kBitsPerByte * 1e6 / baud;
  if (!lost) sent_.push_back({{free_utime_us(), byte}, baud});
}

std::int64_t TransmitLine::free_utime_us() const { return base_utime_us_ + std::llround(free_us_); }

std::vector<TimedByte> TransmitLine::take(std::int64_t utime_us, int host_baud) {
  std::vector<TimedByte> taken;
  for (; !sent_.empty() && sent_.front().timed.utime_us <= utime_us; sent_.pop_front()) {
    const auto& [timed, baud] = sent_.front();
    if (host_baud == 0 || host_baud == baud) {
      taken.push_back(timed);
    } else {
      for (const std::uint8_t byte : garbled(1, baud, host_baud, random_))
        taken.push_back({timed.utime_us, byte});
    }
  }
  return taken;
}

std::optional<std::int64_t> TransmitLine::next_utime_us() const {
  if (sent_.empty()) return std::nullopt;
  return sent_.front().timed.utime_us;
}

void TransmitLine::cut(std::int64_t utime_us) {
  while (!sent_.empty() && sent_.back().timed.utime_us > utime_us) sent_.pop_back();
  base_utime_us_ = utime_us;
  free_us_ = 0.0;
}

std::vector<std::uint8_t> garbled(std::size_t bytes, int sender_baud, int listener_baud,
                                  Random& random) {
  const double for_one =
      std::min(kMostBytesForOne, static_cast<double>(listener_baud) / sender_baud);
  std::vector<std::uint8_t> heard(
      static_cast<std::size_t>(static_cast<double>(bytes) * for_one + random.uniform(0.0, 1.0)));
  for (std::uint8_t& byte : heard) byte = any_byte(random);
  return heard;
}

}  // namespace voxlist::simulation
