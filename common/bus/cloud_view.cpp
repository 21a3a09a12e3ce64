#include "voxlist/bus/cloud_view.h"

#include <bit>
#include <voxlist/pointcloud_t.hpp>

#include "voxlist/system/check.h"

namespace voxlist::bus {
namespace {

// Numbers on the wire have their highest byte first.
std::uint32_t u32_at(const std::uint8_t* at) {
  return std::uint32_t{at[0]} << 24 | std::uint32_t{at[1]} << 16 | std::uint32_t{at[2]} << 8 |
         std::uint32_t{at[3]};
}
float float_at(const std::uint8_t* at) { return std::bit_cast<float>(u32_at(at)); }

// A number that moves on behind what it has read.
class Cursor {
 public:
  explicit Cursor(const std::uint8_t* at) : at_(at) {}

  std::uint32_t u32() { return u32_at(skip(4)); }
  std::uint64_t u64() {
    const std::uint64_t high = u32();
    return high << 32 | u32();
  }
  std::string text() {
    const std::size_t bytes = u32();
    return reinterpret_cast<const char*>(skip(bytes));  // which ends in 0
  }
  const std::uint8_t* skip(std::size_t bytes) {
    const std::uint8_t* from = at_;
    at_ += bytes;
    return from;
  }

 private:
  const std::uint8_t* at_;
};

constexpr std::size_t kFingerprint = 8;
constexpr std::size_t kFloat = 4;
constexpr std::size_t kPoint = 3 * kFloat;

}  // namespace

CloudView::CloudView(Bytes bytes) {
  VOXLIST_CHECK(check_wire<pointcloud_t>(bytes) == Fault::kNone, "a whole pointcloud_t");
  Cursor in(bytes.data());
  in.skip(kFingerprint);
  utime_us_ = static_cast<std::int64_t>(in.u64());
  seq_ = static_cast<std::int32_t>(in.u32());
  in.text();  // frame_id
  size_ = in.u32();
  points_ = in.skip(size_ * kPoint);
  const std::size_t channels = in.u32();
  for (std::size_t i = 0; i < channels; ++i) channel_names_.push_back(in.text());
  values_ = in.skip(0);
}

Eigen::Vector3f CloudView::point(std::size_t i) const {
  const std::uint8_t* at = points_ + i * kPoint;
  return {float_at(at), float_at(at + kFloat), float_at(at + 2 * kFloat)};
}

float CloudView::value(std::size_t channel, std::size_t i) const {
  return float_at(values_ + (channel * size_ + i) * kFloat);
}

}  // namespace voxlist::bus
