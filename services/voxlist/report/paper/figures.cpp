#include "services/voxlist/report/paper/figures.h"

#include <array>

namespace voxlist::desk {

std::span<const PaperFigure> paper_figures() {
  static constexpr std::array kFigures{
      PaperFigure{"scanner", "Section II: what a scan holds", scanner_claims},
      PaperFigure{"fig-4", "Fig. 4: where a scan can be in a map of 20 scans", figure_4},
      PaperFigure{"algorithm-1", "Algorithm 1 on one scan, level by level", algorithm_1},
      PaperFigure{"fig-5", "Fig. 5: from points to voxels", figure_5},
      PaperFigure{"rate", "Section III: particles per second", particle_rate},
      PaperFigure{"fig-6", "Fig. 6: overlaps by chance, from 0.02 to 1.28 m", figure_6},
      PaperFigure{"section-4", "Section IV: the significance of an overlap of 379", significance},
      PaperFigure{"reliability", "Section IV: how sure a pose is, and how often it is right",
                  reliability},
      PaperFigure{"section-5", "Section V: random and systematic error", scanner_error},
      PaperFigure{"fig-7", "Fig. 7: closest points of two scans", figure_7},
      PaperFigure{"fig-8", "Fig. 8: a scan of a room from the side", figure_8},
      PaperFigure{"resolution", "Section V: the best resolution", best_resolution}};
  return kFigures;
}

}  // namespace voxlist::desk
