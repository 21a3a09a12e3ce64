#include "services/voxlist/recording/omissions.h"

#include <fmt/core.h>

namespace voxlist::desk {
namespace {

// Omissions told one by one for each reason; the rest is only counted, so that a damaged log does
// not flood the terminal.
constexpr std::int64_t kToldOfEach = 3;

}  // namespace

void Omissions::add(const std::string& reason, const std::string& detail) {
  const std::int64_t count = ++counts_[reason];
  if (count <= kToldOfEach) console_.warn("left out: " + detail);
  if (count == kToldOfEach)
    console_.warn(fmt::format("more like this ({}) are only counted", reason));
}

void Omissions::remark(const std::string& kind, const std::string& text) {
  if (remarks_[kind] >= kToldOfEach || !told_.insert(text).second) return;
  console_.warn(text);
  if (++remarks_[kind] == kToldOfEach) console_.warn("more like this is not told");
}

std::int64_t Omissions::total() const {
  std::int64_t sum = 0;
  for (const auto& [reason, count] : counts_) sum += count;
  return sum;
}

std::string Omissions::summary() const {
  std::string text;
  for (const auto& [reason, count] : counts_) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, reason);
  }
  return text;
}

}  // namespace voxlist::desk
