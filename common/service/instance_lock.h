#pragma once

#include <string>

namespace voxlist::service {

/// Name of the lock file (system/file_lock.h) of a service on a bus: one copy runs there. Copies
/// with another channel prefix, on another LCM network (the URL without its options), or in another
/// network namespace are on another bus and have another name.
std::string lock_name(const std::string& service, const std::string& url,
                      const std::string& prefix);

}  // namespace voxlist::service
