#include "voxlist/serial/serial_port.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>

#include "voxlist/serial/adapter_latency.h"
#include "voxlist/serial/line_speed.h"

namespace voxlist::serial {
namespace {

// A write that takes longer than this (us) means a dead line: the system's buffer holds any
// request.
constexpr std::int64_t kWriteTimeout_us = 1'000'000;

// Above this speed bytes to an LMS 200 have to be kept apart by this pause: it may refuse bytes
// that come closer than 55 us (telegram listing, 4.3). At 38400 baud a byte takes 260 us anyway.
constexpr int kFastBaud = 38400;
constexpr long kPause_ns = 55'000;

std::string advice(int error) {
  switch (error) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return "plug the adapter in, or correct the port's name";
    case EACCES:
    case EPERM:
      return "add this user to group dialout and log in anew";
    case EBUSY:
    case EWOULDBLOCK:
      return "end the other program that uses it";
    case ENOTTY:
      return "it is no serial port: correct the port's name";
    case EIO:
      return "it was unplugged: plug it in again";
    default:
      return "unplug it and plug it in again";
  }
}

[[noreturn]] void fail(const std::string& path, const std::string& what, int error) {
  const char* reason = error == EWOULDBLOCK ? std::strerror(EBUSY) : std::strerror(error);
  throw PortError(fmt::format("{}: {}: {}: {}", path, what, reason, advice(error)));
}

// TIOCEXCL outlives a killed program there: as long as the simulator has its end open.
bool is_pseudo_terminal(const std::string& path) {
  std::error_code error;
  return std::filesystem::canonical(path, error).parent_path() == "/dev/pts";
}

FileDescriptor open_alone(const std::string& path) {
  FileDescriptor fd(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (fd.get() < 0) fail(path, "cannot be opened", errno);
  if (isatty(fd.get()) == 0) fail(path, "cannot be used", ENOTTY);
  // The lock stops a second driver even of root, whom TIOCEXCL lets pass.
  if (flock(fd.get(), LOCK_EX | LOCK_NB) != 0) fail(path, "cannot be used", errno);
  if (!is_pseudo_terminal(path) && ioctl(fd.get(), TIOCEXCL) != 0)
    fail(path, "cannot be used", errno);
  return fd;
}

// A divisor that another program left would turn 38400 baud into something else. Not all drivers
// know these settings, and none needs them.
void clear_divisor(int fd) {
  serial_struct settings{};
  if (ioctl(fd, TIOCGSERIAL, &settings) != 0) return;
  settings.flags &= ~ASYNC_SPD_MASK;
  settings.flags |= ASYNC_LOW_LATENCY;
  settings.custom_divisor = 0;
  ioctl(fd, TIOCSSERIAL, &settings);
}

}  // namespace

SerialPort::SerialPort(const std::string& path, int baud) : path_(path), fd_(open_alone(path)) {
  clear_divisor(fd());
  set_baud(baud);
  warning_ = quicken_adapter(path);
}

std::optional<Received> SerialPort::read(std::int64_t timeout_us) {
  if (!wait(POLLIN, timeout_us)) return std::nullopt;
  std::array<std::uint8_t, 4096> buffer;
  const ssize_t n = ::read(fd(), buffer.data(), buffer.size());
  if (n > 0) return Received{now_us(), {buffer.begin(), buffer.begin() + n}};
  if (n == 0) fail(path_, "is gone", EIO);
  if (errno == EAGAIN || errno == EINTR) return std::nullopt;
  fail(path_, "is gone", errno);
}

void SerialPort::write(std::span<const std::uint8_t> bytes) {
  const bool pauses = baud_ > kFastBaud;
  while (!bytes.empty()) {
    if (!pauses) {
      write_some(bytes);
      continue;
    }
    std::span<const std::uint8_t> first = bytes.first(1);
    bytes = bytes.subspan(1);
    while (!first.empty()) write_some(first);
    const timespec pause{0, kPause_ns};
    if (!bytes.empty()) nanosleep(&pause, nullptr);
  }
}

void SerialPort::write_some(std::span<const std::uint8_t>& bytes) {
  const ssize_t n = ::write(fd(), bytes.data(), bytes.size());
  if (n >= 0) {
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  } else if (errno == EAGAIN) {
    if (!wait(POLLOUT, kWriteTimeout_us)) fail(path_, "takes no bytes", ETIMEDOUT);
  } else if (errno != EINTR) {
    fail(path_, "is gone", errno);
  }
}

void SerialPort::set_baud(int baud) {
  const auto speed = line_speed(baud);
  termios settings{};
  if (tcgetattr(fd(), &settings) != 0) fail(path_, "is gone", errno);
  make_raw(settings);
  const auto is_set = [&] {
    if (cfsetispeed(&settings, *speed) != 0 || cfsetospeed(&settings, *speed) != 0) return false;
    if (tcsetattr(fd(), TCSANOW, &settings) != 0 || tcgetattr(fd(), &settings) != 0) {
      if (errno != EINVAL) fail(path_, "is gone", errno);
      return false;
    }
    return cfgetospeed(&settings) == *speed;
  };
  if (!speed || !is_set())
    throw PortError(fmt::format(
        "{}: has no speed of {} baud: use an adapter that does, or another speed", path_, baud));
  baud_ = baud;
  if (tcflush(fd(), TCIOFLUSH) != 0) fail(path_, "is gone", errno);
}

void SerialPort::flush() {
  if (tcflush(fd(), TCIFLUSH) != 0) fail(path_, "is gone", errno);
}

std::int64_t SerialPort::now_us() const {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

bool SerialPort::wait(short events, std::int64_t timeout_us) const {
  pollfd wanted{fd(), events, 0};
  const timespec timeout{timeout_us / 1'000'000, timeout_us % 1'000'000 * 1'000};
  const int ready = ppoll(&wanted, 1, &timeout, nullptr);
  if (ready < 0 && errno != EINTR) fail(path_, "is gone", errno);
  if (ready <= 0) return false;
  // What came before it was unplugged is still to be read.
  if ((wanted.revents & events) == 0) fail(path_, "is gone", EIO);
  return true;
}

}  // namespace voxlist::serial
