#include "voxlist/service/service.h"

#include <fmt/core.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/network_report.h"
#include "voxlist/health_t.hpp"
#include "voxlist/service/command_line.h"
#include "voxlist/service/drop_report.h"
#include "voxlist/service/instance_lock.h"
#include "voxlist/service/resource_report.h"
#include "voxlist/service/run_folder.h"
#include "voxlist/service/state_log.h"
#include "voxlist/service/stop.h"
#include "voxlist/system/file_lock.h"
#include "voxlist/system/memory.h"

namespace voxlist::service {
namespace {

// Longest wait for a message before tick() is called: a service is at most this late with what is
// due by time, and an idle one wakes 50 times a second.
constexpr std::chrono::milliseconds kTick(20);

void log_to_stderr(const std::string& name) {
  auto logger =
      std::make_shared<spdlog::logger>(name, std::make_shared<spdlog::sinks::stderr_sink_st>());
  logger->set_pattern("%Y-%m-%d %H:%M:%S.%e %n %l: %v");
  spdlog::set_default_logger(std::move(logger));
}

// The wall clock at the start and the steady clock from there on: nothing periodic stalls when
// somebody sets the clock.
class Clock {
 public:
  std::int64_t now_us() const {
    using std::chrono::duration_cast, std::chrono::microseconds;
    const auto elapsed = std::chrono::steady_clock::now() - steady_start_;
    return duration_cast<microseconds>(wall_start_.time_since_epoch() + elapsed).count();
  }

 private:
  std::chrono::system_clock::time_point wall_start_ = std::chrono::system_clock::now();
  std::chrono::steady_clock::time_point steady_start_ = std::chrono::steady_clock::now();
};

void log_troubles(const bus::Bus& bus, DropReport& drops, std::string& told_error,
                  std::int64_t now_us) {
  for (const std::string& line : drops.due(bus.losses(), now_us)) spdlog::warn("{}", line);
  if (told_error == bus.first_handler_error()) return;
  told_error = bus.first_handler_error();
  spdlog::error("{}", told_error);
}

void log_state(const bus::Health& health, StateLog& states, std::int64_t now_us) {
  using State = bus::Health::State;
  const auto line = states.due(health.state(), health.message(), now_us);
  if (!line) return;
  const auto level = line->state == State::kError     ? spdlog::level::err
                     : line->state == State::kWarning ? spdlog::level::warn
                                                      : spdlog::level::info;
  spdlog::log(level, "{}", line->text);
}

// What goes wrong at the end is told in HEALTH; whoever catches it writes it to the log.
void stop(bus::Bus& bus, bus::Health& health, RunningService& service, std::int64_t now_us) try {
  service.stop();
} catch (const std::exception& error) {
  health.raise("stop", bus::Health::State::kError, error.what());
  bus.publish(bus::kHealth, health.last(now_us, bus.counters()));
  throw;
}

// False: the bus ended before anyone asked for it.
bool run_until_stopped(bus::Bus& bus, bus::Health& health, RunningService& service,
                       bus::NetworkReport& network) {
  const Clock clock;
  DropReport drops;
  StateLog states;
  ResourceReport resources;
  std::string told_error;
  bool open = true;
  while (open && !stop_requested()) {
    open = bus.handle(kTick, service.wake_fd());
    const std::int64_t now_us = clock.now_us();
    service.tick(now_us);
    if (resources.is_due(now_us))
      resources.take(bus.traffic(), memory_of_process(), now_us, health);
    network.take(now_us, health);
    if (const auto message = health.due(now_us, bus.counters()))
      bus.publish(bus::kHealth, *message);
    log_troubles(bus, drops, told_error, now_us);
    log_state(health, states, now_us);
  }
  work_is_done();
  stop(bus, health, service, clock.now_us());
  return open;
}

FileLock take_lock(const ServiceInfo& info, const bus::BusOptions& options) {
  const auto file = run_folder() / lock_name(info.name, options.url, options.prefix);
  auto lock = FileLock::take(file);
  if (!lock) {
    throw std::runtime_error(fmt::format(
        "already runs on this bus as process {}; stop that one first", lock_owner(file)));
  }
  return std::move(*lock);
}

// What a service starts, such as lcm-logger, is on the same bus.
void tell_children(const bus::BusOptions& options) {
  setenv("LCM_DEFAULT_URL", options.url.c_str(), 1);
  setenv("VOXLIST_PREFIX", options.prefix.c_str(), 1);
}

}  // namespace

int run_service(int argc, char** argv, const ServiceInfo& info,
                const std::vector<config::Section>& settings, const CheckSettings& check,
                const MakeService& make) try {
  bus::BusOptions options;
  const auto exit_code = read_command_line(argc, argv, info, settings, check, options);
  if (exit_code) return *exit_code;

  tell_children(options);
  stop_on_signals(info.ends_within_work);
  std::signal(SIGPIPE, SIG_IGN);  // a service outlives whoever reads its log
  log_to_stderr(info.name);
  const FileLock lock = take_lock(info, options);
  bus::Bus bus(options);
  bus::Health health(info.name);
  bus::NetworkReport network(options);
  network.take(0, health);
  const auto service = make(bus, health);
  spdlog::info("started on {}{}", options.url, network.summary());
  const bool wanted =
      run_until_stopped(bus, health, *service, network) || bus::is_recording(options.url);
  if (!wanted)
    throw std::runtime_error(fmt::format("the connection to {} broke; start again", options.url));
  spdlog::info("stopped");
  return 0;
} catch (const Stopped&) {
  spdlog::info("stopped before it had started");
  return 0;
} catch (const std::exception& error) {
  std::cerr << info.name << ": " << error.what() << '\n';
  return 1;
}

}  // namespace voxlist::service
