#include "voxlist/bus/multicast/udp_sockets.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <set>
#include <sstream>
#include <system_error>

namespace voxlist::bus {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> text_of(const char* path) {
  const int fd = open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0) return std::nullopt;
  std::string text;
  std::array<char, 16'384> part;
  ssize_t got = 0;
  while ((got = read(fd, part.data(), part.size())) > 0)
    text.append(part.data(), static_cast<std::size_t>(got));
  close(fd);
  return got < 0 ? std::nullopt : std::optional(text);
}

// number: address:port address:port state sent:waiting timer:when retries uid timeout inode
// references pointer drops
std::optional<UdpSocket> socket_of(const std::string& line) {
  UdpSocket socket;
  unsigned port = 0;
  std::uint64_t waiting = 0;
  const int read = std::sscanf(line.c_str(),
                               "%*d: %*[0-9A-F]:%x %*[0-9A-F]:%*x %*x %*x:%" SCNx64
                               " %*x:%*x %*x %*u %*u %" SCNu64 " %*d %*s %" SCNd64,
                               &port, &waiting, &socket.inode, &socket.dropped_packets);
  if (read != 4) return std::nullopt;
  socket.port = static_cast<int>(port);
  socket.waiting_bytes = static_cast<std::int64_t>(waiting);
  return socket;
}

std::set<std::uint64_t> own_inodes() {
  std::set<std::uint64_t> inodes;
  std::error_code error;
  for (fs::directory_iterator entry("/proc/self/fd", error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code gone;
    std::uint64_t inode = 0;
    const std::string target = fs::read_symlink(entry->path(), gone);
    if (std::sscanf(target.c_str(), "socket:[%" SCNu64 "]", &inode) == 1) inodes.insert(inode);
  }
  return inodes;
}

}  // namespace

std::vector<UdpSocket> parse_udp_sockets(const std::string& table) {
  std::vector<UdpSocket> sockets;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);)
    if (const auto socket = socket_of(line)) sockets.push_back(*socket);
  return sockets;
}

std::optional<std::vector<UdpSocket>> udp_sockets(int port) {
  const auto table = text_of("/proc/net/udp");
  if (!table) return std::nullopt;
  std::vector<UdpSocket> sockets = parse_udp_sockets(*table);
  std::erase_if(sockets, [&](const UdpSocket& socket) { return socket.port != port; });
  return sockets;
}

std::int64_t dropped_by_own_sockets(int port) {
  const auto sockets = udp_sockets(port);
  if (!sockets || sockets->empty()) return 0;
  const std::set<std::uint64_t> own = own_inodes();
  std::int64_t dropped = 0;
  for (const UdpSocket& socket : *sockets)
    if (own.contains(socket.inode)) dropped += socket.dropped_packets;
  return dropped;
}

}  // namespace voxlist::bus
