#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace voxlist::service {

/// Held by the one running copy of a service on a bus. The file holds the owner's process id; the
/// kernel lets go of the lock when the process ends, however it ends.
class InstanceLock {
 public:
  /// Takes the lock; nothing if another process holds it. Throws std::runtime_error if the file
  /// cannot be written.
  static std::optional<InstanceLock> take(const std::filesystem::path& file);

  InstanceLock(InstanceLock&& other) noexcept;
  InstanceLock& operator=(InstanceLock&&) = delete;
  ~InstanceLock();

 private:
  explicit InstanceLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

/// Process id that a lock file holds, "?" if there is none.
std::string lock_owner(const std::filesystem::path& file);

/// Name of the lock file of a service on a bus. Copies with another channel prefix, on another LCM
/// network (the URL without its options), or in another network namespace are on another bus and
/// have another name.
std::string lock_name(const std::string& service, const std::string& url,
                      const std::string& prefix);

}  // namespace voxlist::service
