#include "services/laser_driver/laser_reader.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace voxlist::services {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

// Lines that may wait for the service: three seconds. Beyond that the oldest is dropped.
constexpr std::size_t kQueue = 225;

// Longest wait for a line (us), after which stop and report are looked at.
constexpr std::int64_t kTimeout_us = 50'000;

// Pause between attempts, doubled each time. A device that came back has to be found within 3 s,
// and the search itself takes two.
constexpr auto kShortestPause = 200ms;
constexpr auto kLongestPause = 1000ms;

// Counters and state go to the service this often, as HEALTH does.
constexpr auto kReportPeriod = 1s;

int make_event_fd() {
  const int fd = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (fd < 0) throw std::system_error(errno, std::generic_category(), "cannot make an eventfd");
  return fd;
}

const scanner::Lms200Config& checked(const scanner::Lms200Config& config) {
  if (const std::string wrong = why_invalid(config); !wrong.empty())
    throw std::invalid_argument(wrong);
  return config;
}

bus::Counters counters_of(const scanner::Lms200Report& report) {
  bus::Counters counters = {{"lines", report.lines},
                            {"lost_scans", report.lost_scans},
                            {"crc_errors", report.damaged},
                            {"dazzled_beams", report.dazzled_beams},
                            {"clock_jumps", report.clock_jumps}};
  for (const auto& [reason, count] : report.refused) counters["refused/" + reason] = count;
  return counters;
}

std::int64_t refused_scans(const scanner::Lms200Report& report) {
  std::int64_t sum = 0;
  for (const auto& [reason, count] : report.refused) sum += count;
  return sum;
}

}  // namespace

LaserReader::LaserReader(const scanner::Lms200Config& config, OpenPort open)
    : config_(checked(config)),
      open_(std::move(open)),
      wake_fd_(make_event_fd()),
      pause_(kShortestPause),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

LaserReader::~LaserReader() {
  stop();
  close(wake_fd_);
}

void LaserReader::stop() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

LaserReader::News LaserReader::take() {
  std::uint64_t count = 0;
  // Empty when somebody looks without having been woken.
  [[maybe_unused]] const auto read_bytes = ::read(wake_fd_, &count, sizeof count);
  const std::lock_guard lock(mutex_);
  News news = std::exchange(news_, News{});
  news_.state = news.state;
  return news;
}

void LaserReader::wake() const {
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(wake_fd_, &one, sizeof one);
}

void LaserReader::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) try {
      const auto port = open_(config_.port);
      read(*port, stop);
    } catch (const std::exception& error) {
      tell_failed(error.what());
      pause(stop);
    }
}

// The port stays open while nothing answers: on some robots opening it switches the laser on.
void LaserReader::read(serial::Port& port, const std::stop_token& stop) {
  scanner::Lms200 driver(port, config_, stop);
  told_ = {};
  while (!stop.stop_requested()) try {
      driver.begin();
      tell_connected(driver);
      read_lines(driver, stop);
    } catch (const scanner::Lms200Failure& failure) {
      if (stop.stop_requested()) break;
      tell(driver);
      tell_failed(failure.what());
      if (!failure.is_silent) pause(stop);
    }
  driver.end();
}

void LaserReader::read_lines(scanner::Lms200& driver, const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (auto line = driver.next(kTimeout_us)) {
      pause_ = kShortestPause;
      pass_on(std::move(*line));
    }
    if (steady_clock::now() - told_at_ >= kReportPeriod) tell(driver);
  }
}

void LaserReader::pass_on(LaserLine line) {
  {
    const std::lock_guard lock(mutex_);
    news_.lines.push_back({std::move(line), steady_clock::now()});
    if (news_.lines.size() > kQueue) {
      news_.lines.pop_front();
      ++news_.counts["dropped_lines"];
    }
  }
  wake();
}

void LaserReader::tell(const scanner::Lms200& driver) {
  const scanner::Lms200Report report = driver.report();
  const scanner::Lms200Report before = std::exchange(told_, report);
  told_at_ = steady_clock::now();
  const std::lock_guard lock(mutex_);
  const bus::Counters counted = counters_of(before);
  for (const auto& [name, count] : counters_of(report)) {
    const auto was = counted.find(name);
    const std::int64_t more = count - (was == counted.end() ? 0 : was->second);
    if (more != 0) news_.counts[name] += more;
  }
  constexpr double kBeams = 181.0;
  const auto lines = static_cast<double>(std::max<std::int64_t>(report.lines - before.lines, 1));
  const auto dazzled = static_cast<double>(report.dazzled_beams - before.dazzled_beams);
  const std::int64_t lost = report.lost_scans - before.lost_scans;
  news_.state.polluted = report.polluted;
  news_.state.jitter_us = static_cast<std::int64_t>(report.jitter_us);
  news_.state.dazzled = dazzled / (lines * kBeams);
  // The first scans of all are refused as a matter of course.
  news_.state.lost = before.lines > 0 ? lost + refused_scans(report) - refused_scans(before) : 0;
}

void LaserReader::tell_connected(const scanner::Lms200& driver) {
  const std::string type = driver.report().type;
  {
    const std::lock_guard lock(mutex_);
    news_.state = {};
    news_.state.connected = true;
    news_.state.message = type + " on " + config_.port;
    ++news_.counts["connections"];
  }
  told_at_ = steady_clock::now();
  wake();
}

void LaserReader::tell_failed(const std::string& message) {
  {
    const std::lock_guard lock(mutex_);
    news_.state = {};
    news_.state.failed = true;
    news_.state.message = message;
  }
  wake();
}

void LaserReader::pause(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  stopped_.wait_for(lock, stop, pause_, [] { return false; });
  pause_ = std::min<std::chrono::milliseconds>(2 * pause_, kLongestPause);
}

}  // namespace voxlist::services
