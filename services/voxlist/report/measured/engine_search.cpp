#include "services/voxlist/report/measured/engine_search.h"

#include "services/voxlist/report/measured/filter_trace.h"
#include "voxlist/matching/engines/global_matcher.h"
#include "voxlist/matching/localisation/thread_arena.h"
#include "voxlist/matching/scan/prepared_scan.h"
#include "voxlist/matching/search/global_search.h"

namespace voxlist::desk {
namespace {

constexpr double kReach_m = 10.0;
constexpr std::size_t kPoints = 500;  // as MatcherConfig

}  // namespace

struct EngineAt::Ready {
  matching::GlobalMap map;
  mutable matching::ThreadArena arena{1};
};

EngineAt::EngineAt(const VoxelMap& map, double resolution_m)
    : ready_(new Ready{matching::GlobalMap(map, resolution_m, kReach_m)}) {}

EngineAt::~EngineAt() = default;

EngineSearch EngineAt::search(const Cloud& scan) const {
  EngineSearch result;
  ready_->arena.run([&] {
    const double start = thread_seconds();
    const matching::PreparedScan prepared(scan);
    const auto points = ready_->map.choose_points(prepared, kPoints);
    result.found =
        matching::global_search(ready_->map, points, {.mode_ratio = matching::kModeRatio});
    result.seconds = thread_seconds() - start;
  });
  return result;
}

}  // namespace voxlist::desk
