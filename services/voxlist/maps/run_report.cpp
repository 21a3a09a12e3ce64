#include "services/voxlist/maps/run_report.h"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <numbers>

#include "services/voxlist/output/stop.h"

namespace voxlist::desk {
namespace {

// Scans whose place was asked for.
std::int64_t asked(const RunFigures& figures) { return figures.scans - figures.without_pose; }

const char* remedy(const RunFigures& figures) {
  return figures.odometry ? "scans that are closer together and share more walls would help"
                          : "odometry would help, or scans that are closer together and share more "
                            "walls";
}

// Told from this standard deviation of the scale on: half of what is known before scans tell.
constexpr double kKnown = 0.01;

constexpr double kDegrees = 180.0 / std::numbers::pi;

}  // namespace

RunFigures carry_out(ScanInput& input, const MapRun& run, const std::string& doing,
                     Console& console, const std::function<void(Progress&)>& place_all) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  {
    Progress progress(console, doing);
    place_all(progress);
  }
  RunFigures figures = run.figures();
  figures.elapsed_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  figures.input = input.path().string();
  figures.scans = input.scans();
  figures.left_out = input.omissions().total();
  figures.seconds = input.seconds();
  figures.interrupted = stop_requested();
  if (!input.omissions().empty()) console.warn("left out: " + input.omissions().summary());
  return figures;
}

std::string shortfall(const RunFigures& figures) {
  const std::int64_t missing = asked(figures) - figures.placed;
  if (missing <= 0) return {};
  std::string text =
      fmt::format("{} of {} scans have no place in the map", missing, asked(figures));
  if (figures.pieces > 0)
    text += fmt::format(", {} of them in {} that nothing joins to it", figures.in_pieces,
                        figures.pieces == 1 ? "a piece" : fmt::format("{} pieces", figures.pieces));
  if (figures.first_lost)
    text += fmt::format("; scan {} at {:.1f} s was the first that fitted nowhere",
                        figures.first_lost->number, figures.first_lost->seconds);
  return text + ": " + remedy(figures);
}

std::string odometry_bias(const RunFigures& figures) {
  if (!figures.odometry_bias || figures.odometry_bias->scale_sigma > kKnown) return {};
  const matching::OdometryBias& bias = *figures.odometry_bias;
  const double off = 1.0 / (1.0 + bias.scale) - 1.0;
  return fmt::format(
      "odometry's ways are {:.1f} +- {:.1f} % too {}, and turned by {:.1f} +- {:.1f} deg",
      100.0 * std::abs(off), 100.0 * bias.scale_sigma, off < 0.0 ? "short" : "long",
      -kDegrees * bias.heading_rad, kDegrees * bias.heading_sigma_rad);
}

std::string closed_loops(const RunFigures& figures) {
  if (figures.loops == 0) return {};
  return fmt::format(
      "the drive came back: {} looks at ground of long before agree, and moved it by up to {:.2f} "
      "m",
      figures.loops, figures.loops_moved_m);
}

std::string refused_loops(const RunFigures& figures) {
  if (figures.loops_refused == 0) return {};
  return fmt::format(
      "{} looks agree that the drive came back to where it cannot have been, by how sure it was: "
      "they moved nothing; two places look alike, or scans are bent",
      figures.loops_refused);
}

std::string floor_is_off(const RunFigures& figures) {
  return figures.floor ? what_is_off(*figures.floor) : std::string{};
}

bool mostly_lost(const RunFigures& figures) { return 2 * figures.placed < asked(figures); }

}  // namespace voxlist::desk
