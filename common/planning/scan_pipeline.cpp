#include "voxlist/planning/scan_pipeline.h"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace voxlist::planning {
namespace {

using Scratch = std::unique_ptr<RayScratch>;

// Scratches that wait for a cloud; made as they are needed.
class Pool {
 public:
  explicit Pool(const RayRules& rules) : rules_(rules) {}

  Scratch take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<RayScratch>(rules_);
    Scratch scratch = std::move(free_.back());
    free_.pop_back();
    return scratch;
  }

  void give_back(Scratch scratch) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(scratch));
  }

 private:
  const RayRules rules_;
  std::mutex mutex_;
  std::vector<Scratch> free_;
};

// A cloud's scratch; none where it was stopped.
using Marked = std::shared_ptr<RayScratch>;
using Taken = std::shared_ptr<PosedCloud>;

}  // namespace

bool mark_in_order(const std::function<std::optional<PosedCloud>()>& next, const RayRules& rules,
                   int threads, const std::function<bool()>& stopped,
                   const std::function<void(const RayScratch&)>& count) {
  Pool pool(rules);
  std::atomic<bool> is_stopped = false;
  const auto take = [&](tbb::flow_control& flow) -> Taken {
    auto cloud = is_stopped ? std::nullopt : next();
    if (!cloud) {
      flow.stop();
      return nullptr;
    }
    return std::make_shared<PosedCloud>(*std::move(cloud));
  };
  const auto mark = [&](const Taken& cloud) -> Marked {
    Scratch scratch = pool.take();
    if (!scratch->mark(cloud->T_map_base, cloud->cloud, stopped)) return nullptr;
    return Marked(scratch.release(), [&pool](RayScratch* used) { pool.give_back(Scratch(used)); });
  };
  const auto add = [&](const Marked& scan) {
    is_stopped = is_stopped || !scan;
    if (!is_stopped) count(*scan);
  };
  const int at_once = threads > 0 ? threads : tbb::this_task_arena::max_concurrency();
  tbb::task_arena arena(at_once);
  arena.execute([&] {
    using tbb::filter_mode;
    tbb::parallel_pipeline(static_cast<std::size_t>(at_once),
                           tbb::make_filter<void, Taken>(filter_mode::serial_in_order, take) &
                               tbb::make_filter<Taken, Marked>(filter_mode::parallel, mark) &
                               tbb::make_filter<Marked, void>(filter_mode::serial_in_order, add));
  });
  return !is_stopped;
}

}  // namespace voxlist::planning
