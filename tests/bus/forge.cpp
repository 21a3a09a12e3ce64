#include "tests/bus/forge.h"

#include <array>
#include <functional>

#include "tests/bus/filler.h"
#include "voxlist/bus/channels.h"
#include "voxlist/bus/wire.h"

namespace voxlist::bus {
namespace {

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

// These have the name of a robot's profile in theirs.
constexpr Channel<pixel_map_t> kGrid{"GRID_low"};
constexpr Channel<traversability_t> kTraversability{"TRAVERSABILITY_low"};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      kind(kCloud),     kind(kCloudSlice),     kind(kOdometry), kind(kPose),
      kind(kTruth),     kind(kPoseCovariance), kind(kMapOdom),  kind(kLocalisation),
      kind(kMapUpdate), kind(kFreeSpace),      kind(kKeyframe), kind(kMapRequest),
      kind(kMapEdit),   kind(kMapEdits),       kind(kPoseHint), kind(kOctomap),
      kind(kObstacles), kind(kLaser),          kind(kMirror),   kind(kHealth),
      kind(kGrid),      kind(kTraversability)};
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
