#include "voxlist/service/stop.h"

#include <unistd.h>

#include <csignal>

namespace voxlist::service {
namespace {

constexpr unsigned kGrace_s = 1;

volatile std::sig_atomic_t g_stop_requested = 0;
volatile std::sig_atomic_t g_ends_within_work = 0;

void request_stop(int) {
  if (g_ends_within_work != 0 && g_stop_requested == 0) alarm(kGrace_s);
  g_stop_requested = 1;
}

void end_now(int) {
  constexpr char kText[] = "stopped within its work\n";
  [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, kText, sizeof kText - 1);
  _exit(0);
}

}  // namespace

void stop_on_signals(bool within_work) {
  g_stop_requested = 0;
  g_ends_within_work = within_work ? 1 : 0;
  struct sigaction action = {};
  action.sa_handler = request_stop;
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
  action.sa_handler = end_now;
  sigaction(SIGALRM, &action, nullptr);
}

bool stop_requested() { return g_stop_requested != 0; }

void work_is_done() { alarm(0); }

}  // namespace voxlist::service
