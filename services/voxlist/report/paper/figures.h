#pragma once

#include <span>
#include <string>

#include "services/voxlist/report/measured/scene.h"
#include "services/voxlist/report/page/entry.h"

namespace voxlist::desk {

/// A figure or claim of the paper: its name in the page and on the command line, and what measures
/// it. Each measures anew, so that one alone says the same as all of them.
struct PaperFigure {
  const char* id;
  const char* title;
  Entry (*measure)(const Scene& scene);
};

/// All of them, in the order of the paper.
std::span<const PaperFigure> paper_figures();

Entry scanner_claims(const Scene& scene);
Entry figure_4(const Scene& scene);
Entry algorithm_1(const Scene& scene);
Entry figure_5(const Scene& scene);
Entry particle_rate(const Scene& scene);
Entry figure_6(const Scene& scene);
Entry significance(const Scene& scene);
Entry reliability(const Scene& scene);
Entry scanner_error(const Scene& scene);
Entry figure_7(const Scene& scene);
Entry figure_8(const Scene& scene);
Entry best_resolution(const Scene& scene);

}  // namespace voxlist::desk
