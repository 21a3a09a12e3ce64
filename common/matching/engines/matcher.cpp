#include "voxlist/matching/engines/matcher.h"

#include <stdexcept>

#include "voxlist/matching/engines/filter_matcher.h"
#include "voxlist/matching/engines/global_matcher.h"
#include "voxlist/matching/engines/window_matcher.h"

namespace voxlist::matching {
namespace {

class SearchMatcher : public Matcher {
 public:
  SearchMatcher(const OccupancyMap& map, const MatcherConfig& config)
      : surfels_(map), global_(map, surfels_, config), window_(map, surfels_, config) {}

  Match match(const Cloud& scan, const std::optional<PoseWindow>& window) override {
    return window ? window_.match(scan, *window) : global_.match(scan);
  }

  Match match_rivals(const Cloud& scan) override { return global_.match_rivals(scan); }

  void map_grew(const ChangedBlocks& grown) override {
    surfels_.map_changed();
    global_.map_changed();
    window_.map_grew(grown);
  }

 private:
  SurfelMap surfels_;
  GlobalMatcher global_;
  WindowMatcher window_;
};

}  // namespace

std::unique_ptr<Matcher> make_matcher(const OccupancyMap& map, const MatcherConfig& config) {
  if (config.engine == "search") return std::make_unique<SearchMatcher>(map, config);
  if (config.engine == "particle_filter") return make_filter_matcher(map, config);
  throw std::invalid_argument("engine = \"" + config.engine +
                              "\": must be search or particle_filter");
}

}  // namespace voxlist::matching
