#include "services/mapper/loops/background.h"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <exception>

namespace voxlist::services {
namespace {

// The thread's nice value: threads that drive the robot go before it.
constexpr int kNice = 10;

}  // namespace

void Background::start(Work work) {
  wait();
  stop_ = is_done_ = false;
  failure_.clear();
  thread_ = std::thread([this, work = std::move(work)] { run(work); });
}

void Background::run(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNice);
  try {
    work(stop_);
  } catch (const std::exception& error) {
    failure_ = error.what();
  }
  took_us_ = std::chrono::duration_cast<std::chrono::microseconds>(
                 std::chrono::steady_clock::now() - start)
                 .count();
  const std::lock_guard lock(mutex_);
  is_done_ = true;
  done_.notify_all();
}

void Background::wait() {
  if (thread_.joinable()) thread_.join();
}

bool Background::wait_for(double seconds) {
  std::unique_lock lock(mutex_);
  return done_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return !is_busy(); });
}

void Background::cancel() {
  stop_ = true;
  wait();
}

}  // namespace voxlist::services
