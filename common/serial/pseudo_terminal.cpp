#include "voxlist/serial/pseudo_terminal.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "voxlist/serial/line_speed.h"
#include "voxlist/serial/port.h"

namespace voxlist::serial {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& link, const std::string& what, int error) {
  throw PortError(fmt::format("{}: {}: {}", link.string(), what, std::strerror(error)));
}

FileDescriptor open_master(const fs::path& link) {
  FileDescriptor master(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (master.get() < 0 || grantpt(master.get()) != 0 || unlockpt(master.get()) != 0)
    fail(link, "cannot make a pseudo-terminal", errno);
  termios settings{};
  tcgetattr(master.get(), &settings);
  make_raw(settings);  // else what is sent before the other end is opened comes back as an echo
  tcsetattr(master.get(), TCSANOW, &settings);
  return master;
}

fs::path other_end_of(int master, const fs::path& link) {
  std::array<char, 128> name;
  if (ptsname_r(master, name.data(), name.size()) != 0)
    fail(link, "cannot name a pseudo-terminal", errno);
  // poll() tells that nobody has the other end open only after it was opened and closed once.
  const FileDescriptor once(::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (once.get() < 0) fail(link, std::string("cannot open ") + name.data(), errno);
  return name.data();
}

void put_link(const fs::path& link, const fs::path& target) {
  std::error_code error;
  if (fs::exists(fs::symlink_status(link, error)) && !fs::is_symlink(link, error))
    fail(link, "is a file that is no link: remove it, or choose another name", EEXIST);
  fs::path beside = link;
  beside += fmt::format(".{}", getpid());
  fs::remove(beside, error);
  fs::create_symlink(target, beside, error);
  if (!error) fs::rename(beside, link, error);
  if (error) fail(link, "cannot make the link", error.value());
}

}  // namespace

PseudoTerminal::PseudoTerminal(const fs::path& link)
    : link_(link), master_(open_master(link)), other_end_(other_end_of(fd(), link)) {
  put_link(link_, other_end_);
}

PseudoTerminal::~PseudoTerminal() {
  std::error_code error;
  if (fs::read_symlink(link_, error) == other_end_) fs::remove(link_, error);
}

std::vector<std::uint8_t> PseudoTerminal::read() {
  std::array<std::uint8_t, 4096> buffer;
  const ssize_t n = ::read(fd(), buffer.data(), buffer.size());
  if (n <= 0) return {};
  return {buffer.begin(), buffer.begin() + n};
}

std::size_t PseudoTerminal::write(std::span<const std::uint8_t> bytes) {
  if (!is_open()) return bytes.size();
  const ssize_t n = ::write(fd(), bytes.data(), bytes.size());
  return n < 0 ? 0 : static_cast<std::size_t>(n);
}

int PseudoTerminal::baud() const {
  termios settings{};
  return tcgetattr(fd(), &settings) == 0 ? baud_of(cfgetospeed(&settings)) : 0;
}

bool PseudoTerminal::is_open() const {
  pollfd asked{fd(), 0, 0};
  return ::poll(&asked, 1, 0) == 0;
}

}  // namespace voxlist::serial
