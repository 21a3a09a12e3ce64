#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "voxlist/bus/wire.h"

namespace voxlist::bus {

/// An encoded pointcloud_t, read where it lies: of a large one, only what is asked for costs
/// anything. Nothing of it is judged: points may be not finite, channels may have any names.
class CloudView {
 public:
  /// Precondition: the bytes are a whole pointcloud_t (check_wire says kNone), and stay where they
  /// are.
  explicit CloudView(Bytes bytes);

  std::int64_t utime_us() const { return utime_us_; }
  std::int32_t seq() const { return seq_; }

  /// How many points it has.
  std::size_t size() const { return size_; }
  Eigen::Vector3f point(std::size_t i) const;

  const std::vector<std::string>& channel_names() const { return channel_names_; }

  /// Of the channel with this number.
  float value(std::size_t channel, std::size_t i) const;

 private:
  std::int64_t utime_us_ = 0;
  std::int32_t seq_ = 0;
  std::size_t size_ = 0;
  std::vector<std::string> channel_names_;
  const std::uint8_t* points_ = nullptr;
  const std::uint8_t* values_ = nullptr;
};

}  // namespace voxlist::bus
