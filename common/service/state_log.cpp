#include "voxlist/service/state_log.h"

#include <algorithm>

namespace voxlist::service {
namespace {

// A line more may be told after this (us).
constexpr std::int64_t kPause_us = 1'000'000;

std::string words_of(std::string message) {
  std::erase_if(message, [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-'; });
  return message;
}

}  // namespace

std::optional<StateLog::Line> StateLog::due(bus::Health::State state, const std::string& message,
                                            std::int64_t now_us) {
  std::string words = words_of(message);
  const bool is_news = state != told_state_ || words != told_words_;
  if (!is_news || !may_tell(now_us)) return std::nullopt;
  told_state_ = state;
  told_words_ = std::move(words);
  return Line{state, message.empty() ? "all is well" : message};
}

bool StateLog::may_tell(std::int64_t now_us) {
  if (!since_us_) since_us_ = now_us;
  const std::int64_t earned = std::max<std::int64_t>(0, (now_us - *since_us_) / kPause_us);
  lines_left_ = std::min(kBurst, lines_left_ + earned);
  *since_us_ += earned * kPause_us;
  if (lines_left_ == 0) return false;
  --lines_left_;
  return true;
}

}  // namespace voxlist::service
