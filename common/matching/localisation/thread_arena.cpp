#include "voxlist/matching/localisation/thread_arena.h"

#include <tbb/task_arena.h>

namespace voxlist::matching {

struct ThreadArena::Arena : tbb::task_arena {
  using tbb::task_arena::task_arena;
};

ThreadArena::ThreadArena(int threads) {
  constexpr int kAllCores = tbb::task_arena::automatic;
  arena_ = std::make_unique<Arena>(threads > 0 ? threads : kAllCores);
}

ThreadArena::~ThreadArena() = default;

void ThreadArena::run(const std::function<void()>& work) { arena_->execute(work); }

}  // namespace voxlist::matching
