#include "services/viewer/recorder.h"

#include <fmt/chrono.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "voxlist/system/state_folder.h"

namespace voxlist::services {
namespace {

// LCM's tools lose most large messages with LCM's own receive buffer.
std::string url_with_buffer() {
  const char* url = std::getenv("LCM_DEFAULT_URL");
  std::string text = url ? url : "udpm://239.255.76.67:7667?ttl=0";
  if (!text.starts_with("udpm://") || text.find("recv_buf_size=") != std::string::npos) return text;
  return text + (text.find('?') == std::string::npos ? '?' : '&') + "recv_buf_size=8000000";
}

std::string channels() {
  const char* prefix = std::getenv("VOXLIST_PREFIX");
  return (prefix ? prefix : std::string()) + ".*";
}

std::filesystem::path file_name(std::int64_t now_us) {
  const std::tm time = fmt::localtime(static_cast<std::time_t>(now_us / 1'000'000));
  return state_folder() / "recordings" / fmt::format("{:%Y-%m-%d_%H-%M-%S}.lcm", time);
}

// Starts a program that has none of this process's files but its outputs: a socket that it held
// would outlive this process. Returns errno.
int spawn(const char* const* arguments, int& pid) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  const int failed = posix_spawnp(&pid, arguments[0], &actions, nullptr,
                                  const_cast<char* const*>(arguments), environ);
  posix_spawn_file_actions_destroy(&actions);
  return failed;
}

}  // namespace

std::string Recorder::start(std::int64_t now_us) {
  if (is_on()) return "it records already";
  file_ = file_name(now_us);
  std::error_code error;
  std::filesystem::create_directories(file_.parent_path(), error);
  if (error) return file_.parent_path().string() + ": " + error.message();
  const std::string url = "--lcm-url=" + url_with_buffer(), channel = "--channel=" + channels();
  const std::string out = file_.string();
  // setpriv: where this process is killed, the recording ends, too.
  const std::array<const char*, 10> arguments{
      "setpriv",         "--pdeathsig", "TERM",          "lcm-logger", "--increment",
      "--split-mb=1000", url.c_str(),   channel.c_str(), out.c_str(),  nullptr};
  const int failed = spawn(arguments.data(), pid_);
  if (failed == 0) return {};
  pid_ = -1;
  return std::string("cannot start lcm-logger (package liblcm-bin): ") + std::strerror(failed);
}

void Recorder::stop() {
  if (!is_on()) return;
  kill(pid_, SIGTERM);
  for (int i = 0; i < 100 && is_on(); ++i) usleep(10'000);
  if (is_on()) kill(pid_, SIGKILL);
}

bool Recorder::is_on() {
  if (pid_ > 0 && waitpid(pid_, nullptr, WNOHANG) != 0) pid_ = -1;
  return pid_ > 0;
}

}  // namespace voxlist::services
