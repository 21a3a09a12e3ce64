#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

namespace voxlist::bench {

/// A process on one core of the machine; killed when it is not ended before.
class Child {
 public:
  /// Runs a program; what it says goes to /dev/null. Call it before this process has any thread.
  Child(const std::vector<std::string>& command, int core);

  /// Runs a function, and ends with it.
  Child(const std::function<void()>& work, int core);

  ~Child();
  Child(Child&& other) noexcept;
  Child& operator=(Child&&) = delete;

  /// Asks it to end, waits, and tells how much processor time it used (s).
  double end();

  /// The same without asking.
  double wait();

 private:
  pid_t pid_ = -1;
};

/// This process runs on the other cores, where there are any.
void leave_core(int core);

}  // namespace voxlist::bench
