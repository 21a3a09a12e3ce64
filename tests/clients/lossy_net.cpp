// A network that loses packets, for a program that is started with this library in LD_PRELOAD.
// LOSSY_NET_PERCENT of the packets that it receives are lost, in an order that follows from
// LOSSY_NET_SEED. Of those that it sends on the channel LOSSY_NET_CHANNEL, the ones numbered from
// LOSSY_NET_FIRST to LOSSY_NET_LAST (from 1) are lost.
#include <dlfcn.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <random>

namespace {

int number(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atoi(text) : otherwise;
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

bool is_datagram(int socket) {
  int family = 0, type = 0;
  socklen_t size = sizeof family, type_size = sizeof type;
  ::getsockopt(socket, SOL_SOCKET, SO_DOMAIN, &family, &size);
  ::getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &type_size);
  return family == AF_INET && type == SOCK_DGRAM;
}

bool loses_next_received() {
  static const int percent = number("LOSSY_NET_PERCENT", 0);
  static std::mutex mutex;
  static std::mt19937 random(static_cast<unsigned>(number("LOSSY_NET_SEED", 0)));
  const std::lock_guard lock(mutex);
  return percent > 0 && static_cast<int>(random() % 100) < percent;
}

// LCM's header is 8 bytes; the channel's name follows, and then the message.
bool loses_sent(const char* bytes, std::size_t size) {
  static const char* const channel = std::getenv("LOSSY_NET_CHANNEL");
  static const int first = number("LOSSY_NET_FIRST", 1), last = number("LOSSY_NET_LAST", 0);
  static int sent = 0;
  if (channel == nullptr || size < 9 || std::memcmp(bytes, "LC02", 4) != 0) return false;
  if (::strnlen(bytes + 8, size - 8) != std::strlen(channel) ||
      std::strncmp(bytes + 8, channel, size - 8) != 0)
    return false;
  ++sent;
  return sent >= first && sent <= last;
}

}  // namespace

// A packet that is lost is one of a byte, which LCM leaves out.
extern "C" ssize_t recvmsg(int socket, msghdr* message, int flags) {
  static auto* const real = next<ssize_t(int, msghdr*, int)>("recvmsg");
  const ssize_t size = real(socket, message, flags);
  return size > 1 && is_datagram(socket) && loses_next_received() ? 1 : size;
}

extern "C" ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  static auto* const real = next<ssize_t(int, const msghdr*, int)>("sendmsg");
  char bytes[512];
  std::size_t size = 0, total = 0;
  for (std::size_t i = 0; i < message->msg_iovlen; ++i) {
    const iovec& part = message->msg_iov[i];
    const std::size_t taken = std::min(part.iov_len, sizeof bytes - size);
    std::memcpy(bytes + size, part.iov_base, taken);
    size += taken;
    total += part.iov_len;
  }
  if (is_datagram(socket) && loses_sent(bytes, size)) return static_cast<ssize_t>(total);
  return real(socket, message, flags);
}
