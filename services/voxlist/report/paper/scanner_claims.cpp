#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include "services/voxlist/report/measured/statistics.h"
#include "services/voxlist/report/paper/figures.h"
#include "voxlist/matching/paper/particle_set.h"
#include "voxlist/simulation/scanner/ideal_sweep.h"

namespace voxlist::desk {
namespace {

struct Seen {
  double points, farthest_m;
};

Seen seen_by(const std::vector<PlacedScan>& scans) {
  std::vector<double> points;
  double farthest_m = 0.0;
  for (const PlacedScan& scan : scans) {
    points.push_back(static_cast<double>(scan.cloud.points.size()));
    for (std::size_t i = 0; i < scan.cloud.points.size(); ++i)
      farthest_m = std::max(
          farthest_m, static_cast<double>((scan.cloud.points[i] - scan.cloud.origin(i)).norm()));
  }
  return {moments(points).mean, farthest_m};
}

// Headings of equation 1 at each resolution, for a scan that reaches 8 m.
Table headings() {
  Table table{
      "Equation 1, dtheta = eps / R with R = 8 m: 2 pi / dtheta is no whole number, so the "
      "circle is cut into the next greater number of steps, which doubles from level to "
      "level.",
      {"eps (m)", "dtheta (deg)", "headings"},
      {}};
  matching::PoseLattice lattice(1.28, 8.0);
  for (int level = 0; level < 7; ++level, lattice = lattice.finer())
    table.rows.push_back(
        {fmt::format("{:.2f}", lattice.resolution_m()),
         fmt::format("{:.3f}", lattice.heading_step_rad() * 180.0 / std::numbers::pi),
         fmt::format("{}", lattice.headings())});
  return table;
}

}  // namespace

Entry scanner_claims(const Scene& scene) {
  const Seen seen = seen_by(scene.tour());
  const simulation::IdealSweepConfig sweep;
  const double spacing_deg = 360.0 / (sweep.lines_per_second * sweep.sweep_s);
  Entry entry;
  entry.paper =
      "Scans at 1 Hz with a horizontal resolution of 1 deg and a vertical one of 5 deg; up to 5000 "
      "points; 0.5 m < r < 8 m, 25 deg < theta < 155 deg; 4.8 s for 1 deg both ways.";
  entry.setup = fmt::format("The simulated scanner on a tour of {} scans through four rooms.",
                            scene.tour().size());
  entry.comparisons = {
      {"points a scan, in the mean", "up to 5000", fmt::format("{:.0f}", seen.points),
       "the robot itself and the wedge above take the rest of 9825 beams"},
      {"between lines at 1 Hz", "5 deg", fmt::format("{:.1f} deg", spacing_deg),
       "360 deg / 75 lines"},
      {"a sweep with lines 1 deg apart", "4.8 s",
       fmt::format("{:.1f} s", 360.0 / sweep.lines_per_second), "360 lines at 75 Hz"},
      {"farthest point", "8 m", fmt::format("{:.2f} m", seen.farthest_m),
       "the way over the mirror is counted, too"}};
  entry.tables = {headings()};
  entry.differs =
      "A fan of the mirror scanner goes all round (phi of 360 deg); the paper's 75 to 105 deg is "
      "its blind wedge straight up. Figs. 1 to 3 are a photograph, a drawing and a flow chart: "
      "there is nothing to measure in them.";
  return entry;
}

}  // namespace voxlist::desk
