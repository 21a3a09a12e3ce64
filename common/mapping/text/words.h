#pragma once

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>

#include "voxlist/geometry/pose.h"

namespace voxlist::mapping {

/// Takes words off a text, one after the other; after the first that is none, nothing is told any
/// more.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  /// Takes this word if it is the next one.
  bool is(std::string_view word) {
    skip_blanks();
    if (!text_.starts_with(word)) return false;
    text_.remove_prefix(word.size());
    return true;
  }

  template <class T>
  T number() {
    skip_blanks();
    T value{};
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc{}) good_ = false;
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return value;
  }

  Pose2 pose() {
    Pose2 pose;
    for (double* part : {&pose.x_m, &pose.y_m, &pose.yaw_rad}) *part = number<double>();
    return pose;
  }

  /// Whether all numbers were there.
  bool good() const { return good_; }

 private:
  void skip_blanks() {
    text_.remove_prefix(std::min(text_.find_first_not_of(" \n"), text_.size()));
  }

  std::string_view text_;
  bool good_ = true;
};

}  // namespace voxlist::mapping
