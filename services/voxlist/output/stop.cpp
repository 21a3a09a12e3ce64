#include "services/voxlist/output/stop.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

namespace voxlist::desk {
namespace {

// Several threads ask; the signal handler says so.
std::atomic<bool> g_stop_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free);

// Work that looks at stop_requested() has so long (s).
constexpr unsigned kGrace_s = 1;

void request_stop(int) {
  g_stop_requested = true;
  alarm(kGrace_s);
}

void end_now(int) {
  constexpr char kText[] = "voxlist: interrupted\n";
  [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, kText, sizeof kText - 1);
  _exit(kInterrupted);
}

}  // namespace

void stop_on_interrupt() {
  g_stop_requested = false;
  struct sigaction action = {};
  action.sa_handler = request_stop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  action.sa_handler = end_now;
  sigaction(SIGALRM, &action, nullptr);
  alarm(0);
}

bool stop_requested() {
  if (g_stop_requested) alarm(0);
  return g_stop_requested;
}

}  // namespace voxlist::desk
