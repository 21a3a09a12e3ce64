#include "services/simulator/live_scanner.h"

namespace voxlist::services {

LiveScanner::LiveScanner(const simulation::MirrorScanner& scanner, const SimulatorConfig& config,
                         std::int64_t start_utime_us)
    : start_utime_us_(start_utime_us),
      ports_(scanner, config, start_utime_us),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void LiveScanner::run(const std::stop_token& stop) {
  using std::chrono::microseconds, std::chrono::milliseconds;
  for (Clock::time_point now = start_; !stop.stop_requested(); now = Clock::now()) {
    ports_.serve(start_utime_us_ + std::chrono::duration_cast<microseconds>(now - start_).count());
    std::this_thread::sleep_until(now + milliseconds(1));
  }
}

}  // namespace voxlist::services
