#include "voxlist/serial/text_edge_source.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "voxlist/serial/adapter_latency.h"
#include "voxlist/serial/line_speed.h"
#include "voxlist/serial/port.h"

namespace voxlist::serial {
namespace {

// One call reads no more, so that a flood does not hold up its caller.
constexpr int kMaxReads = 16;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw PortError(fmt::format(
      "clock at {}: {}; check the cable, the path and that you may read it (group dialout)",
      path.string(), what));
}

void set_up(int fd, const std::filesystem::path& path, int baud) {
  termios settings{};
  if (tcgetattr(fd, &settings) != 0) fail(path, std::strerror(errno));
  const auto speed = line_speed(baud);
  if (!speed) fail(path, fmt::format("no such speed: {}", baud));
  make_raw(settings);
  cfsetispeed(&settings, *speed);
  cfsetospeed(&settings, *speed);
  if (tcsetattr(fd, TCSANOW, &settings) != 0) fail(path, std::strerror(errno));
  tcflush(fd, TCIFLUSH);
  quicken_adapter(path);
}

}  // namespace

TextEdgeSource::TextEdgeSource(const std::filesystem::path& path, int baud, Clock clock)
    : path_(path), clock_(std::move(clock)) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) fail(path, std::strerror(errno));
  // A fifo that is also open for writing does not end when its writer does.
  const int mode = S_ISFIFO(status.st_mode) ? O_RDWR : O_RDONLY;
  file_ = FileDescriptor(open(path.c_str(), mode | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (file_.get() < 0) fail(path, std::strerror(errno));
  if (isatty(file_.get())) set_up(file_.get(), path, baud);
}

std::vector<std::int64_t> TextEdgeSource::read(std::int64_t) {
  std::vector<std::int64_t> edges_us;
  std::array<std::uint8_t, 4096> bytes;
  for (int i = 0; i < kMaxReads; ++i) {
    const ssize_t count = ::read(file_.get(), bytes.data(), bytes.size());
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) break;
    if (count < 0) fail(path_, std::strerror(errno));
    if (count == 0) fail(path_, "it is gone");
    const auto more = text_.feed(clock_(), std::span(bytes).first(static_cast<std::size_t>(count)));
    edges_us.insert(edges_us.end(), more.begin(), more.end());
  }
  return edges_us;
}

}  // namespace voxlist::serial
