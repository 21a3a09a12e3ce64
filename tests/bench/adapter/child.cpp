#include "tests/bench/adapter/child.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <utility>

namespace voxlist::bench {
namespace {

void stay_on(int core) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(static_cast<std::size_t>(core), &cores);
  sched_setaffinity(0, sizeof cores, &cores);
}

// In the child.
void begin(int core) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  stay_on(core);
}

void be_silent() {
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

}  // namespace

Child::Child(const std::vector<std::string>& command, int core) : pid_(fork()) {
  if (pid_ != 0) return;
  begin(core);
  be_silent();
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  _exit(1);
}

Child::Child(const std::function<void()>& work, int core) : pid_(fork()) {
  if (pid_ != 0) return;
  begin(core);
  work();
  _exit(0);
}

Child::Child(Child&& other) noexcept : pid_(std::exchange(other.pid_, -1)) {}

Child::~Child() {
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

double Child::end() {
  kill(pid_, SIGTERM);
  return wait();
}

double Child::wait() {
  rusage used{};
  wait4(std::exchange(pid_, -1), nullptr, 0, &used);
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

void leave_core(int core) {
  cpu_set_t cores;
  sched_getaffinity(0, sizeof cores, &cores);
  CPU_CLR(static_cast<std::size_t>(core), &cores);
  if (CPU_COUNT(&cores) > 0) sched_setaffinity(0, sizeof cores, &cores);
}

}  // namespace voxlist::bench
