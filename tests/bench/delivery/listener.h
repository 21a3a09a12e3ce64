#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

namespace voxlist::bench {

/// What reached one listener: from the time in a message to the end of its reading (us).
struct Heard {
  std::vector<std::int64_t> delays_us;
};

/// A process of its own that listens to CLOUD.
class Listener {
 public:
  enum class Kind {
    kLcm,  ///< LCM as it comes, with the system's default receive buffer
    kBus,  ///< as a service, where the kernel gives no more than that default
  };

  /// Call it before this process has any thread.
  explicit Listener(Kind kind);

  /// Waits until it listens.
  void wait_until_ready();

  /// Ends it.
  Heard finish();

 private:
  pid_t pid_;
  int from_ = -1;
  int to_ = -1;
};

}  // namespace voxlist::bench
