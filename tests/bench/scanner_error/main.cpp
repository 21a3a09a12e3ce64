// The paper's section V on a simulated scanner: how wrong its clouds are, before and after
// calibration. Usage: scanner_error [PLOT.png]
#include <algorithm>
#include <cstdio>
#include <numeric>
#include <string>

#include "services/voxlist/report/measured/scanner_measures.h"
#include "services/voxlist/report/measured/scanner_recording.h"
#include "voxlist/drawing/plot.h"

namespace voxlist::bench {
namespace {

// Distances to the closest points of the next scan.
struct Closest {
  std::array<double, 40> shares;
  double mode_m, median_m, mean_m;
};

struct Figures {
  desk::RandomError random;
  double dimensions_m, positions_m;
  Closest drifting, repeating;
};

// Distances between two scans that the same side of the mirror made.
Closest measure_closest(const desk::ScannerRecording& recording,
                        const scanner::CloudAssemblerConfig& assembler) {
  const std::vector<Cloud> clouds = recording.clouds(assembler);
  const auto distances = desk::closest_distances(clouds[clouds.size() - 3], clouds.back());
  Closest closest;
  closest.shares = desk::by_millimetre(distances);
  const auto mode = std::ranges::max_element(closest.shares) - closest.shares.begin();
  closest.mode_m = (static_cast<double>(mode) + 0.5) * 1e-3;
  closest.median_m = distances[distances.size() / 2];
  closest.mean_m = std::accumulate(distances.begin(), distances.end(), 0.0) /
                   static_cast<double>(distances.size());
  return closest;
}

Figures measure(const desk::ScannerRecording& drifting, const desk::ScannerRecording& repeating,
                const scanner::CloudAssemblerConfig& assembler) {
  const std::vector<Cloud> clouds = drifting.clouds(assembler);
  const auto points = drifting.noise_free_turn(assembler);
  return {desk::random_error(clouds[clouds.size() - 2], clouds.back()),
          desk::error_on_six_metres(points), desk::error_at_six_metres(points),
          measure_closest(drifting, assembler), measure_closest(repeating, assembler)};
}

// Misaligned as a scanner that was built with care but never calibrated.
simulation::MirrorScannerConfig uncalibrated() {
  simulation::MirrorScannerConfig config;
  config.mirror.phase_deg = {0.25, -0.25};
  config.mirror.height_m += 0.005;
  config.mirror.offset_m = {0.004, 0.001};
  config.mirror.axis_yaw_deg = 0.3;
  config.mirror.axis_roll_deg = 0.3;
  config.latency_s = 0.001;
  return config;
}

// The paper's "flexing between the stepper motor axle and the mirror".
simulation::MirrorScannerConfig flexing() {
  simulation::MirrorScannerConfig config;
  config.mirror.flex_deg = 0.33;
  return config;
}

scanner::CloudAssemblerConfig as_drawn() {
  scanner::CloudAssemblerConfig assembler;
  assembler.use_odometry = false;
  return assembler;
}

scanner::CloudAssemblerConfig calibrated(const desk::ScannerRecording& recording) {
  scanner::CloudAssemblerConfig assembler = as_drawn();
  const calibration::Calibration calibration =
      calibration::calibrate(recording.input(), assembler, {});
  for (const std::string& refusal : calibration.refusals)
    std::printf("calibration refused: %s\n", refusal.c_str());
  if (calibration.answer && calibration.refusals.empty())
    assembler.geometry =
        calibration::with_parameters(assembler.geometry, calibration.answer->parameters);
  return assembler;
}

void print(const std::vector<Figures>& columns) {
  const auto row = [&](const char* name, const char* paper, auto metres) {
    std::printf("%-44s%8s", name, paper);
    for (const Figures& figures : columns) std::printf("%12.1f", metres(figures) * 1e3);
    std::printf("\n");
  };
  std::printf("%-44s%8s%24s%24s\n", "", "", "misaligned", "plate flexes 0.33 deg");
  std::printf("%-44s%8s%12s%12s%12s%12s\n", "mm", "paper", "before", "calibrated", "before",
              "calibrated");
  row("ceiling about its plane (z), RMS", "20", [](auto& f) { return f.random.z_m; });
  row("walls about their planes (x), RMS", "20", [](auto& f) { return f.random.x_m; });
  row("walls about their planes (y), RMS", "20", [](auto& f) { return f.random.y_m; });
  row("dimensions of 6 m, mean error", "70", [](auto& f) { return f.dimensions_m; });
  row("positions at 6 m, mean error", "", [](auto& f) { return f.positions_m; });
  std::printf("closest point of the next scan\n");
  row("  lines on the same spots: mode", "4", [](auto& f) { return f.repeating.mode_m; });
  row("    median", "6", [](auto& f) { return f.repeating.median_m; });
  row("    mean", "11", [](auto& f) { return f.repeating.mean_m; });
  row("  lines drift, laser at 75.03 Hz: mode", "4", [](auto& f) { return f.drifting.mode_m; });
  row("    median", "6", [](auto& f) { return f.drifting.median_m; });
  row("    mean", "11", [](auto& f) { return f.drifting.mean_m; });
}

drawing::PlotSeries curve(const std::string& name, const io::Rgb& colour, const Closest& closest) {
  drawing::PlotSeries series{name, colour, {}};
  for (std::size_t i = 0; i < closest.shares.size(); ++i)
    series.points.emplace_back(static_cast<double>(i) + 0.5, closest.shares[i] * 1e2);
  return series;
}

drawing::PlotSeries mark(const std::string& name, const io::Rgb& colour, double at_mm,
                         double height) {
  return {name, colour, {{at_mm, 0.0}, {at_mm, height}}};
}

void plot(const std::string& file, const Figures& calibrated) {
  const double top = *std::ranges::max_element(calibrated.repeating.shares) * 1e2;
  drawing::draw_plot(
      {"distance to the closest point of the next scan", "mm", "%"},
      {curve("same spots", {30, 90, 200}, calibrated.repeating),
       curve("drifting", {200, 60, 40}, calibrated.drifting),
       mark("paper: mode", {60, 60, 60}, 4.0, top), mark("median", {130, 130, 130}, 6.0, top),
       mark("mean", {190, 190, 190}, 11.0, top)})
      .write_png(file);
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  std::vector<Figures> columns;
  for (voxlist::simulation::MirrorScannerConfig config : {uncalibrated(), flexing()}) {
    const voxlist::desk::ScannerRecording drifting(config);
    config.turns_per_second = 75.0;
    const voxlist::desk::ScannerRecording repeating(config);
    columns.push_back(measure(drifting, repeating, as_drawn()));
    columns.push_back(measure(drifting, repeating, calibrated(drifting)));
  }
  print(columns);
  if (argc > 1) plot(argv[1], columns[1]);
}
