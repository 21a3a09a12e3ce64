#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace voxlist::services {

/// Work in a thread of its own, of low priority: one thing at a time. What it throws is told as
/// text. Use from one thread.
class Background {
 public:
  /// Work that looks at this now and then, and ends when it is true.
  using Stop = std::atomic<bool>;
  using Work = std::function<void(const Stop&)>;

  Background() = default;
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;
  ~Background() { cancel(); }

  /// Precondition: it is not busy.
  void start(Work work);

  bool is_busy() const { return thread_.joinable() && !is_done_; }

  /// Waits for the work.
  void wait();

  /// Waits for so long at most (s). Whether it is done.
  bool wait_for(double seconds);

  /// Asks the work to end, and waits for that.
  void cancel();

  /// Why the last work failed; empty when it did not.
  const std::string& failure() const { return failure_; }

  /// How long it took (us).
  std::int64_t took_us() const { return took_us_; }

 private:
  void run(const Work& work);

  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable done_;
  Stop stop_ = false;
  std::atomic<bool> is_done_ = true;
  std::string failure_;
  std::int64_t took_us_ = 0;
};

}  // namespace voxlist::services
