#include <arpa/inet.h>
#include <fmt/core.h>
#include <sys/socket.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/output/console.h"
#include "voxlist/system/file_descriptor.h"

namespace voxlist::desk {
namespace {

// The descriptor that a program finds with LISTEN_FDS=1, as systemd hands it over.
constexpr int kHandedOver = 3;

struct ListenOptions {
  std::uint16_t port = 0;
  std::vector<std::string> command;
};

// A socket that listens on this machine's own address; -1 where the port is taken.
int listening_on(std::uint16_t port) {
  FileDescriptor fd(socket(AF_INET, SOCK_STREAM, 0));
  const int on = 1;
  setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto* generic = reinterpret_cast<const sockaddr*>(&address);
  const bool listens =
      bind(fd.get(), generic, sizeof address) == 0 && listen(fd.get(), SOMAXCONN) == 0;
  return listens ? fd.release() : -1;
}

int run(const ListenOptions& options) {
  int fd = listening_on(options.port);
  if (fd < 0) fd = listening_on(0);
  if (fd < 0) throw std::runtime_error("no port of 127.0.0.1 can be had");
  if (fd != kHandedOver) dup2(fd, kHandedOver);
  if (fd != kHandedOver) close(fd);
  setenv("LISTEN_FDS", "1", 1);
  std::vector<char*> arguments;
  for (const std::string& word : options.command)
    arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  throw std::runtime_error(fmt::format("{}: {}", options.command[0], std::strerror(errno)));
}

}  // namespace

void add_listen(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "listen", "Runs a command with a socket that listens here, for a viewer in another network.");
  const auto options = std::make_shared<ListenOptions>();
  command->add_option("port", options->port, "of 127.0.0.1; any that is free where it is taken")
      ->required();
  command->add_option("command", options->command, "what is run, with LISTEN_FDS=1")->required();
  command->footer("Example:\n  voxlist listen 7668 -- scripts/netns build/bin/viewer");
  command->callback([options, &chosen] { chosen = [options](Console&) { return run(*options); }; });
}

}  // namespace voxlist::desk
