#include "voxlist/viewing/scene/board.h"

#include <utility>

namespace voxlist::viewing {

void Board::put(const std::string& name, std::string json, std::int64_t now_us,
                std::vector<std::uint8_t> bytes) {
  if (!numbers_.contains(name) && numbers_.size() >= kMostTopics) return;
  std::int64_t& number = numbers_[name];
  by_number_.erase(number);
  number = ++last_;
  by_number_[number] = {name, std::move(json), std::move(bytes), now_us};
}

void Board::drop(const std::string& prefix) {
  auto name = numbers_.lower_bound(prefix);
  while (name != numbers_.end() && name->first.starts_with(prefix)) {
    by_number_.erase(name->second);
    name = numbers_.erase(name);
  }
}

void Board::drop_all_but(const std::string& name) {
  std::erase_if(numbers_, [&](const auto& topic) {
    if (topic.first == name) return false;
    by_number_.erase(topic.second);
    return true;
  });
}

Board::Entry Board::next_after(std::int64_t seen) const {
  const auto next = by_number_.upper_bound(seen);
  if (next == by_number_.end()) return {seen, nullptr};
  return {next->first, &next->second};
}

}  // namespace voxlist::viewing
