// How many large clouds reach listeners in other processes, and how late, by LCM's own sender and
// by ours, with the receive buffers that Debian gives. It makes a private network for itself.
// Usage: delivery [--seconds S] [--points N] [--rate HZ] [--busy PROCESSES]
#include <fmt/core.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "tests/bench/delivery/listener.h"
#include "tests/bench/delivery/sender.h"

namespace {

using namespace voxlist::bench;
using Kind = Listener::Kind;
using Sender = Sending::Sender;

struct Options {
  double seconds = 3;
  std::size_t points = 100'000;
  double rate_hz = 10;
  int busy = 0;
};

Options read_options(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--seconds") options.seconds = std::atof(argv[i + 1]);
    if (name == "--points") options.points = std::strtoul(argv[i + 1], nullptr, 10);
    if (name == "--rate") options.rate_hz = std::atof(argv[i + 1]);
    if (name == "--busy") options.busy = std::atoi(argv[i + 1]);
  }
  return options;
}

bool enter_private_network() {
  if (unshare(CLONE_NEWNET) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
  return std::system("ip link set lo up && ip route add 224.0.0.0/4 dev lo") == 0;
}

// Processes that take what they can of the machine, until this one ends.
std::vector<pid_t> make_busy(int processes) {
  std::vector<pid_t> pids;
  for (int i = 0; i < processes; ++i) {
    pids.push_back(fork());
    if (pids.back() != 0) continue;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (volatile unsigned n = 0;;) n = n + 1;
  }
  return pids;
}

double percentile_ms(std::vector<std::int64_t>& delays_us, std::size_t percent) {
  if (delays_us.empty()) return 0;
  std::ranges::sort(delays_us);
  return static_cast<double>(delays_us[(delays_us.size() - 1) * percent / 100]) / 1000;
}

void print(const char* what, int sent, std::vector<Heard> heard) {
  for (Heard& one : heard) {
    fmt::print("    {:<12} {:>4} of {} lost, {:6.1f} ms median, {:6.1f} ms p99\n", what,
               sent - static_cast<int>(one.delays_us.size()), sent,
               percentile_ms(one.delays_us, 50), percentile_ms(one.delays_us, 99));
  }
}

std::vector<Heard> finish(std::vector<Listener>& listeners) {
  std::vector<Heard> heard;
  for (Listener& listener : listeners) heard.push_back(listener.finish());
  return heard;
}

void measure(const char* name, const Sending& sending) {
  std::vector<Listener> services;
  for (int i = 0; i < 3; ++i) services.emplace_back(Kind::kBus);
  std::vector<Listener> others;
  others.emplace_back(Kind::kLcm);
  for (Listener& listener : services) listener.wait_until_ready();
  for (Listener& listener : others) listener.wait_until_ready();
  const Sent sent = send_clouds(sending);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  fmt::print("  {}: {} B, publishing takes {:.1f} ms at most, {:.0f} % of a core\n", name,
             sent.bytes, sent.longest_call_ms, 100 * sent.processor_share);
  print("service", sending.clouds, finish(services));
  print("plain LCM", sending.clouds, finish(others));
}

void compare(const Options& options, bool with_origins) {
  Sending sending{.points = options.points,
                  .with_origins = with_origins,
                  .rate_hz = options.rate_hz,
                  .clouds = static_cast<int>(options.seconds * options.rate_hz)};
  fmt::print("{} points at {} Hz{}\n", options.points, options.rate_hz,
             with_origins ? ", with the origins of their rays" : "");
  sending.sender = Sender::kLcm;
  measure("LCM's sender", sending);
  sending.sender = Sender::kBus;
  measure("voxlist's sender", sending);
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = read_options(argc, argv);
  if (!enter_private_network()) {
    fmt::print("no private network here: this user may not make namespaces\n");
    return 0;
  }
  // Listeners are made after what was printed: each has a copy of what waits to be.
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const std::vector<pid_t> busy = make_busy(options.busy);
  compare(options, false);
  compare(options, true);
  for (const pid_t pid : busy) {
    kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
  }
  return 0;
}
