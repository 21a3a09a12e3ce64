#include "voxlist/service/instance_lock.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace voxlist::service {
namespace {

std::string network_namespace() {
  struct stat info;
  return stat("/proc/self/ns/net", &info) == 0 ? std::to_string(info.st_ino) : "0";
}

std::string as_file_name(std::string text) {
  for (char& c : text) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.') c = '_';
  }
  return text;
}

}  // namespace

std::optional<InstanceLock> InstanceLock::take(const std::filesystem::path& file) {
  const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (descriptor < 0)
    throw std::runtime_error(fmt::format("{}: {}", file.string(), std::strerror(errno)));
  InstanceLock lock(descriptor);
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) return std::nullopt;
  const std::string owner = fmt::format("{}\n", getpid());
  if (ftruncate(descriptor, 0) != 0 || write(descriptor, owner.data(), owner.size()) < 0) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), std::strerror(errno)));
  }
  return lock;
}

InstanceLock::InstanceLock(InstanceLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

InstanceLock::~InstanceLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::string lock_owner(const std::filesystem::path& file) {
  std::string owner;
  std::ifstream(file) >> owner;
  return owner.empty() ? "?" : owner;
}

std::string lock_name(const std::string& service, const std::string& url,
                      const std::string& prefix) {
  const std::string network = url.substr(0, url.find('?'));
  return fmt::format("{}-{}-{}.lock", service, as_file_name(prefix + "-" + network),
                     network_namespace());
}

}  // namespace voxlist::service
