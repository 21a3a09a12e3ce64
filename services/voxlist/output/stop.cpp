#include "services/voxlist/output/stop.h"

#include <unistd.h>

#include <csignal>

namespace voxlist::desk {
namespace {

volatile std::sig_atomic_t g_stop_requested = 0;

// Work that looks at stop_requested() has so long (s).
constexpr unsigned kGrace_s = 1;

void request_stop(int) {
  g_stop_requested = 1;
  alarm(kGrace_s);
}

void end_now(int) {
  constexpr char kText[] = "voxlist: interrupted\n";
  [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, kText, sizeof kText - 1);
  _exit(kInterrupted);
}

}  // namespace

void stop_on_interrupt() {
  g_stop_requested = 0;
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
  if (g_stop_requested != 0) alarm(0);
  return g_stop_requested != 0;
}

}  // namespace voxlist::desk
