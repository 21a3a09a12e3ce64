#include "voxlist/io/clouds/point_rows.h"

#include <algorithm>
#include <array>
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

// A float holds seconds up to this to 10 ms: what is greater is a time of day, of the week or since
// 1970.
constexpr double kGreat = 1e5;

bool fits_float(double value) { return std::abs(value) <= std::numeric_limits<float>::max(); }

}  // namespace

bool PointRows::is_point_column(const std::string& name) {
  return std::ranges::find(kNames, lower(name)) != kNames.end();
}

PointRows::PointRows(const std::vector<std::string>& names, FurtherColumns* further)
    : slots_(names.size()), is_wide_(names.size()), row_(kNames.size()), further_(further) {
  std::array<int, kNames.size()> seen{};
  for (std::size_t column = 0; column < names.size(); ++column) {
    const auto found = std::find(kNames.begin(), kNames.end(), lower(names[column]));
    if (found != kNames.end()) {
      slots_[column] = static_cast<std::size_t>(found - kNames.begin());
      if (++seen[*slots_[column]] > 1) {
        throw FormatError("has two columns named " + std::string(*found));
      }
    } else if (further_ && !names[column].empty()) {
      slots_[column] = kNames.size() + further_->names.size();
      further_->names.push_back(names[column]);
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
  if (further_) further_->values.resize(further_->names.size());
  if (further_) row_.resize(kNames.size() + further_->names.size());
}

void PointRows::finish_row() {
  const auto end = row_.begin() + kNames.size();
  if (!further_ && !std::all_of(row_.begin(), end, fits_float)) {
    return;
  }
  const auto vector_at = [&](std::size_t i) {
    return Eigen::Vector3d(row_[i], row_[i + 1], row_[i + 2]).cast<float>().eval();
  };
  cloud_.points.push_back(vector_at(0));
  if (has_origins_) {
    cloud_.origins.push_back(vector_at(3));
  }
  if (further_) finish_further();
}

void PointRows::finish_further() {
  if (first_.empty()) first_ = row_;
  for (std::size_t column = 0; column < slots_.size(); ++column) {
    if (!wants(column) || *slots_[column] < kNames.size()) continue;
    const std::size_t slot = *slots_[column];
    const bool shifts = is_wide_[column] && std::abs(first_[slot]) > kGreat;
    const double value = shifts ? row_[slot] - first_[slot] : row_[slot];
    further_->values[slot - kNames.size()].push_back(static_cast<float>(value));
  }
}

void PointRows::reserve(std::size_t rows) {
  cloud_.points.reserve(rows);
  cloud_.origins.reserve(has_origins_ ? rows : 0);
}

}  // namespace voxlist::io
