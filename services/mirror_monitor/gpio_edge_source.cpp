#include "services/mirror_monitor/gpio_edge_source.h"

#include <fmt/core.h>
#include <gpiod.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "voxlist/serial/port.h"

namespace voxlist::services {
namespace {

std::int64_t us_of(const timespec& time) { return time.tv_sec * 1'000'000LL + time.tv_nsec / 1000; }

std::int64_t clock_us(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return us_of(time);
}

// Kernels since 5.7 stamp with the monotonic clock, older ones with the wall clock.
std::int64_t to_wall_us(std::int64_t stamp_us) {
  const std::int64_t wall_us = clock_us(CLOCK_REALTIME), steady_us = clock_us(CLOCK_MONOTONIC);
  const bool steady = std::llabs(stamp_us - steady_us) < std::llabs(stamp_us - wall_us);
  return steady ? stamp_us + (wall_us - steady_us) : stamp_us;
}

[[noreturn]] void fail(const std::string& where) {
  throw serial::PortError(
      fmt::format("clock at {}: {}; check chip and pin (gpioinfo), that nothing else uses the pin, "
                  "and that you may (group gpio)",
                  where, std::strerror(errno)));
}

}  // namespace

struct GpioEdgeSource::Line {
  std::string where;
  std::unique_ptr<gpiod_chip, decltype(&gpiod_chip_close)> chip;
  gpiod_line* line = nullptr;  // the chip's
};

GpioEdgeSource::GpioEdgeSource(const std::string& chip, unsigned pin)
    : line_(new Line{fmt::format("{}/{}", chip, pin),
                     {gpiod_chip_open_lookup(chip.c_str()), &gpiod_chip_close}}) {
  if (!line_->chip) fail(line_->where);
  line_->line = gpiod_chip_get_line(line_->chip.get(), pin);
  if (line_->line == nullptr || gpiod_line_request_rising_edge_events(line_->line, "voxlist") != 0)
    fail(line_->where);
}

GpioEdgeSource::~GpioEdgeSource() = default;

std::vector<std::int64_t> GpioEdgeSource::read(std::int64_t) {
  std::vector<std::int64_t> edges_us;
  constexpr timespec kNow{0, 0};
  std::array<gpiod_line_event, 16> events;
  for (int i = 0; i < 16; ++i) {
    const int waiting = gpiod_line_event_wait(line_->line, &kNow);
    if (waiting < 0) fail(line_->where);
    if (waiting == 0) break;
    const int count = gpiod_line_event_read_multiple(line_->line, events.data(), events.size());
    if (count < 0) fail(line_->where);
    for (int k = 0; k < count; ++k)
      edges_us.push_back(to_wall_us(us_of(events[static_cast<std::size_t>(k)].ts)));
  }
  return edges_us;
}

int GpioEdgeSource::wake_fd() const { return gpiod_line_event_get_fd(line_->line); }

}  // namespace voxlist::services
