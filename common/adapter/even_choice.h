#pragma once

#include <cstddef>
#include <cstdint>

namespace voxlist::adapter {

/// Which rows of a cloud are kept, so that about `at_most` are (a handful more or less), evenly in
/// whatever order they come: multiples of the golden ratio fall evenly into [0, 1), and so do those
/// of every second, 16th or 64th row. A stride would keep one ring of a laser whose rings take
/// turns. Equal counts give equal choices.
class EvenChoice {
 public:
  EvenChoice(std::size_t rows, std::size_t at_most)
      : all_(rows <= at_most), limit_(all_ ? 0 : share(rows, at_most)) {}

  bool keeps(std::size_t row) const { return all_ || row * kGolden < limit_; }

 private:
  // 2^64 over the golden ratio.
  static constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15;

  // at_most / rows of 2^64.
  static std::uint64_t share(std::size_t rows, std::size_t at_most) {
    return UINT64_MAX / rows * at_most;
  }

  bool all_;
  std::uint64_t limit_;
};

}  // namespace voxlist::adapter
