#include "voxlist/bus/multicast/paced_sender.h"

#include <algorithm>
#include <utility>

namespace voxlist::bus {
namespace {

// Longest pause that is paid for (us): long enough for the largest message. It keeps the product
// below from overflowing after a long pause.
constexpr std::int64_t kMaxPause_us = 60'000'000;

}  // namespace

bool PacedSender::push(std::size_t bytes, std::function<void()>& send, std::deque<Item>& queue) {
  const auto size = static_cast<std::int64_t>(bytes);
  if (queued_bytes_ + size > options_.max_queued_bytes) return false;
  queue.push_back({size, std::move(send)});
  queued_bytes_ += size;
  return true;
}

void PacedSender::run(std::int64_t now_us) {
  const std::int64_t pause_us =
      has_run_ ? std::clamp<std::int64_t>(now_us - last_run_us_, 0, kMaxPause_us) : kMaxPause_us;
  has_run_ = true;
  last_run_us_ = now_us;
  budget_bytes_ =
      std::min(budget_bytes_ + pause_us * options_.bytes_per_ms / 1000, options_.burst_bytes);
  while (!idle() && budget_bytes_ > 0) send_one(first_.empty() ? queue_ : first_);
}

void PacedSender::send_one(std::deque<Item>& queue) {
  const Item item = std::move(queue.front());
  queue.pop_front();
  queued_bytes_ -= item.bytes;
  budget_bytes_ -= item.bytes;
  item.send();
}

void PacedSender::clear() {
  first_.clear();
  queue_.clear();
  queued_bytes_ = 0;
}

}  // namespace voxlist::bus
