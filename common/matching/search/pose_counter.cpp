#include "voxlist/matching/search/pose_counter.h"

#include <algorithm>

namespace voxlist::matching {
namespace {

// Points between two looks at whether a lane can still matter: a look costs about as much as eight
// points. It changes speed alone. A judgement.
constexpr std::size_t kCheckEvery = 64;

}  // namespace

WindowCounters PoseCounter::count(const Node& node, std::int32_t part, std::uint64_t lanes,
                                  int least) {
  const auto places = points_.places(node.group, part);
  const std::int64_t moved = map_.moved(node.x, node.y);
  WindowCounters counters;
  for (std::size_t begin = 0; begin < places.size(); begin += kCheckEvery) {
    const std::size_t end = std::min(places.size(), begin + kCheckEvery);
    for (std::size_t i = begin; i < end; i += 8) {
      std::uint64_t words[8] = {};
      for (std::size_t k = 0; k < std::min<std::size_t>(8, end - i); ++k)
        words[k] = map_.window(places[i + k], moved);
      counters.add8(words);
    }
    const auto rest = static_cast<int>(places.size() - end);
    if ((lanes & lanes_from(counters, std::max(0, least - rest))) == 0) return {};
  }
  return counters;
}

}  // namespace voxlist::matching
