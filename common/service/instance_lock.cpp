#include "voxlist/service/instance_lock.h"

#include <fmt/core.h>
#include <sys/stat.h>

#include <cctype>

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

std::string lock_name(const std::string& service, const std::string& url,
                      const std::string& prefix) {
  const std::string network = url.substr(0, url.find('?'));
  return fmt::format("{}-{}-{}.lock", service, as_file_name(prefix + "-" + network),
                     network_namespace());
}

}  // namespace voxlist::service
