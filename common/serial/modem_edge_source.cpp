#include "voxlist/serial/modem_edge_source.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <linux/serial.h>
#include <pthread.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <map>
#include <stdexcept>
#include <thread>

#include "voxlist/serial/port.h"
#include "voxlist/system/file_descriptor.h"

namespace voxlist::serial {
namespace {

// Wakes the waiting thread at the end; a handler that does nothing makes its ioctl return.
constexpr int kWakeSignal = SIGURG;
void do_nothing(int) {}

int bit_of(const std::string& line) {
  static const std::map<std::string, int> kBits = {
      {"cts", TIOCM_CTS}, {"dcd", TIOCM_CD}, {"dsr", TIOCM_DSR}, {"ri", TIOCM_RI}};
  const auto found = kBits.find(line);
  if (found == kBits.end())
    throw std::invalid_argument(
        fmt::format("no modem line is called {}: cts, dcd, dsr or ri", line));
  return found->second;
}

std::int64_t wall_us() {
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
  throw PortError("clock at " + path.string() + ": " + std::strerror(error) +
                  "; check the path, that you may read it (group dialout), and that the port can "
                  "wait for its modem lines (TIOCMIWAIT: a built-in port or a good USB adapter)");
}

}  // namespace

// What the thread sends through the pipe: times, and a negative one for an error.
class ModemEdgeSource::Waiter {
 public:
  Waiter(const std::filesystem::path& path, int bit)
      : path_(path),
        bit_(bit),
        port_(open(path.c_str(), O_RDONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
    int state = 0;
    std::array<int, 2> ends{};
    if (port_.get() < 0 || ioctl(port_.get(), TIOCMGET, &state) != 0 ||
        pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC) != 0) {
      fail(path, errno);
    }
    out_ = FileDescriptor(ends[0]);
    in_ = FileDescriptor(ends[1]);
    struct sigaction action = {};
    action.sa_handler = do_nothing;
    sigaction(kWakeSignal, &action, nullptr);
    thread_ = std::thread([this] { wait(); });
  }

  ~Waiter() {
    stop_ = true;
    // Again and again: the signal may come just before the ioctl.
    while (!done_) {
      pthread_kill(thread_.native_handle(), kWakeSignal);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    thread_.join();
  }

  std::vector<std::int64_t> read() {
    std::vector<std::int64_t> edges_us;
    std::int64_t time_us = 0;
    for (int i = 0; i < 4096 && ::read(out_.get(), &time_us, sizeof time_us) == sizeof time_us;
         ++i) {
      if (time_us < 0) fail(path_, static_cast<int>(-time_us));
      edges_us.push_back(time_us);
    }
    return edges_us;
  }

  int wake_fd() const { return out_.get(); }

 private:
  void wait() {
    while (!stop_) {
      if (ioctl(port_.get(), TIOCMIWAIT, bit_) != 0) {
        if (errno == EINTR) continue;
        send(-errno);
        break;
      }
      const std::int64_t time_us = wall_us();
      int state = 0;
      const bool rising = ioctl(port_.get(), TIOCMGET, &state) == 0 && (state & bit_) != 0;
      if (rising) send(time_us);
    }
    done_ = true;
  }

  void send(std::int64_t value) {
    [[maybe_unused]] const auto sent = write(in_.get(), &value, sizeof value);
  }

  std::filesystem::path path_;
  int bit_;
  FileDescriptor port_, out_, in_;
  std::atomic<bool> stop_ = false, done_ = false;
  std::thread thread_;
};

ModemEdgeSource::ModemEdgeSource(const std::filesystem::path& path, const std::string& line)
    : waiter_(std::make_unique<Waiter>(path, bit_of(line))) {}
ModemEdgeSource::~ModemEdgeSource() = default;

std::vector<std::int64_t> ModemEdgeSource::read(std::int64_t) { return waiter_->read(); }
int ModemEdgeSource::wake_fd() const { return waiter_->wake_fd(); }

}  // namespace voxlist::serial
