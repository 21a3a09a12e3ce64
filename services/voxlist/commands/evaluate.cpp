#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <numbers>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/output/console.h"
#include "voxlist/evaluation/evaluation.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/poses/trajectory.h"

namespace voxlist::desk {
namespace {

struct EvaluateOptions {
  std::filesystem::path trajectory;
  std::filesystem::path truth;
  std::filesystem::path plot;

  std::filesystem::path png() const {
    return plot.empty() ? trajectory.parent_path() / "evaluation.png" : plot;
  }
};

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
constexpr double kPercent = 100.0;

// Below this share of the true poses the errors say little of the run.
constexpr double kEnough = 0.5;

std::string line(const std::string& name, const std::vector<std::string>& cells) {
  std::string text = fmt::format("{:32}", name);
  for (const std::string& cell : cells) text += fmt::format("{:>10}", cell);
  return text;
}

std::string line(const std::string& name, const evaluation::ErrorStatistics& errors,
                 double scale = 1.0) {
  std::vector<std::string> cells;
  for (const double value : {errors.rmse, errors.mean, errors.median, errors.max}) {
    cells.push_back(fmt::format("{:.4f}", value * scale));
  }
  return line(name, cells);
}

void tell(const evaluation::TrajectoryErrors& errors, Console& console) {
  const bool by_time = errors.association == evaluation::Association::kByTime;
  console.say(fmt::format("{} of {} poses matched by {}", errors.matched, errors.in_truth,
                          by_time ? "time" : "scan number"));
  console.say(line("error", {"rmse", "mean", "median", "max"}));
  console.say("absolute, best fit");
  console.say(line("  position (m)", errors.aligned_m));
  console.say(line("  heading (deg)", errors.aligned_heading_rad, kDegreesPerRadian));
  console.say("absolute, from the first pose on");
  console.say(line("  position (m)", errors.anchored_m));
  if (errors.anchored_3d_m) console.say(line("  position with height (m)", *errors.anchored_3d_m));
  console.say(line("  heading (deg)", errors.anchored_heading_rad, kDegreesPerRadian));
  console.say(line("  last position (m)", {fmt::format("{:.4f}", errors.end_position_m)}));
  console.say("relative");
  console.say(line("  pose to pose (m)", errors.step_m));
  console.say(line("  pose to pose (deg)", errors.step_rad, kDegreesPerRadian));
  console.say(line("  over 1 m and more (%)", errors.per_metre_m, kPercent));
  console.say(line("  over 1 m and more (deg/m)", errors.per_metre_rad, kDegreesPerRadian));
}

void warn_of_few(const evaluation::TrajectoryErrors& errors, Console& console) {
  if (static_cast<double>(errors.matched) >= kEnough * static_cast<double>(errors.in_truth)) return;
  console.warn(fmt::format(
      "only {} of {} true poses have a pose of the trajectory: the errors are of these alone. Was "
      "the robot lost at the others, are their times of another clock, or does the truth come more "
      "often than scans?",
      errors.matched, errors.in_truth));
}

io::PoseTable read(const std::filesystem::path& path, Console& console) {
  io::PoseTable table = io::read_poses(path);
  for (const std::string& note : io::notes_on(table)) console.warn(path.string() + ": " + note);
  return table;
}

int run(const EvaluateOptions& options, Console& console) {
  const io::PoseTable trajectory = read(options.trajectory, console);
  const io::PoseTable truth = read(options.truth, console);
  const auto errors = evaluation::evaluate(io::trajectory_of(trajectory), truth);
  if (!errors) {
    throw io::FileError(
        options.truth, fmt::format("has no pose for any of {}, check that both are of the same run",
                                   options.trajectory.string()));
  }
  tell(*errors, console);
  warn_of_few(*errors, console);
  const drawing::Picture picture = evaluation::draw_errors(*errors);
  const auto plot = options.png();
  picture.write_png(plot);
  picture.write_svg(std::filesystem::path(plot).replace_extension(".svg"));
  console.say(plot.string());
  return 0;
}

}  // namespace

void add_evaluate(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "evaluate", "Compares a trajectory with the true poses: absolute and relative errors.");
  const auto options = std::make_shared<EvaluateOptions>();
  command->add_option("TRAJECTORY", options->trajectory, "trajectory.tum of a map folder")
      ->required();
  command
      ->add_option("POSES", options->truth,
                   "table of the true poses (poses.csv, or a file of TUM, KITTI or EuRoC)")
      ->required();
  command->add_option("-o,--output", options->plot,
                      "the plot to write as PNG, with an SVG of the same name beside it; default "
                      "evaluation.png beside the trajectory");
  command->footer(
      "Example:\n"
      "  voxlist evaluate hall_map/trajectory.tum hall/poses.csv");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return run(*options, console); };
  });
}

}  // namespace voxlist::desk
