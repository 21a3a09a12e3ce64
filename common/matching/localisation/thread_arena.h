#pragma once

#include <functional>
#include <memory>

namespace voxlist::matching {

/// The threads that one object computes with. Several may be used in one process, and none limits
/// another.
class ThreadArena {
 public:
  /// Most threads, the caller's included; 0: one for each core.
  explicit ThreadArena(int threads);
  ~ThreadArena();

  /// Calls the work and waits for it; what it computes in parallel uses these threads.
  void run(const std::function<void()>& work);

 private:
  struct Arena;
  std::unique_ptr<Arena> arena_;
};

}  // namespace voxlist::matching
