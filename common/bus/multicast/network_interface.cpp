#include "voxlist/bus/multicast/network_interface.h"

#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include "voxlist/system/file_descriptor.h"

namespace voxlist::bus {

std::optional<NetworkInterface> network_interface(const std::string& name) {
  ifreq request{};
  if (name.empty() || name.size() >= IFNAMSIZ) return std::nullopt;
  name.copy(request.ifr_name, IFNAMSIZ - 1);
  const FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (ioctl(socket.get(), SIOCGIFFLAGS, &request) != 0) return std::nullopt;
  const auto flags = static_cast<unsigned short>(request.ifr_flags);
  const auto has = [flags](int flag) { return (flags & flag) != 0; };
  NetworkInterface found{name, has(IFF_LOOPBACK), has(IFF_UP), has(IFF_RUNNING),
                         has(IFF_MULTICAST)};
  if (ioctl(socket.get(), SIOCGIFMTU, &request) == 0) found.mtu_bytes = request.ifr_mtu;
  return found;
}

}  // namespace voxlist::bus
