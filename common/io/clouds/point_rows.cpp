#include "voxlist/io/clouds/point_rows.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <string_view>

#include "voxlist/io/files/cursor.h"

namespace voxlist::io {
namespace {

constexpr std::array<std::string_view, 6> kNames{"x", "y", "z", "origin_x", "origin_y", "origin_z"};

std::string lower(std::string text) {
  for (char& c : text) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return text;
}

bool fits_float(double value) { return std::abs(value) <= std::numeric_limits<float>::max(); }

}  // namespace

PointRows::PointRows(const std::vector<std::string>& names) : slots_(names.size()) {
  std::array<int, kNames.size()> seen{};
  for (std::size_t column = 0; column < names.size(); ++column) {
    const auto found = std::find(kNames.begin(), kNames.end(), lower(names[column]));
    if (found != kNames.end()) {
      slots_[column] = static_cast<std::size_t>(found - kNames.begin());
      if (++seen[*slots_[column]] > 1) {
        throw FormatError("has two columns named " + std::string(*found));
      }
    }
  }
  if (seen[0] + seen[1] + seen[2] != 3) {
    throw FormatError("its points have no x, y and z");
  }
  const int origins = seen[3] + seen[4] + seen[5];
  if (origins != 0 && origins != 3) {
    throw FormatError("has some but not all of origin_x, origin_y and origin_z");
  }
  has_origins_ = origins == 3;
}

void PointRows::finish_row() {
  if (!std::all_of(row_.begin(), row_.end(), fits_float)) {
    return;
  }
  const auto vector_at = [&](std::size_t i) {
    return Eigen::Vector3d(row_[i], row_[i + 1], row_[i + 2]).cast<float>().eval();
  };
  cloud_.points.push_back(vector_at(0));
  if (has_origins_) {
    cloud_.origins.push_back(vector_at(3));
  }
}

void PointRows::reserve(std::size_t rows) {
  cloud_.points.reserve(rows);
  cloud_.origins.reserve(has_origins_ ? rows : 0);
}

}  // namespace voxlist::io
