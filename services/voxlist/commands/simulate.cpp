#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <variant>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/live/bus_options.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/fresh_file.h"
#include "services/voxlist/output/progress.h"
#include "services/voxlist/output/stop.h"
#include "services/voxlist/recording/simulated_log.h"
#include "voxlist/config/config.h"
#include "voxlist/config/tables.h"
#include "voxlist/simulation/run/simulated_run.h"

namespace voxlist::desk {
namespace {

struct SimulateOptions {
  std::filesystem::path log;
  std::filesystem::path settings;
  double seconds = 0.0;
  bool still = false;
};

struct SimulateSettings {
  simulation::SimulationConfig simulation;
  scanner::CloudAssemblerConfig assembler;
  std::string prefix;
};

// The robot's own body as the assembler is told it, with room for noise.
std::vector<double> mask(const std::vector<simulation::Box>& body) {
  constexpr double kMargin_m = 0.03;
  std::vector<double> bounds;
  for (const simulation::Box& box : body)
    for (Eigen::Index i = 0; i < 3; ++i) {
      bounds.push_back(box.centre_m[i] - box.half_m[i] - kMargin_m);
      bounds.push_back(box.centre_m[i] + box.half_m[i] + kMargin_m);
    }
  return bounds;
}

// What `voxlist calibrate` needs: a robot that stands in a room for a minute, at two speeds of its
// mirror.
void stand_still(simulation::SimulationConfig& config) {
  constexpr double kUsual_s = 60.0, kFasterSweep_s = 0.6;
  config.stand_in_room = std::max(config.stand_in_room, 0);
  if (config.duration_s == 0.0) config.duration_s = kUsual_s;
  simulation::StepperMotorConfig& motor = config.scanner.motor;
  if (motor.sweep_s.size() != 1) return;
  motor.sweep_s.push_back(kFasterSweep_s * motor.sweep_s.front());
  motor.from_s.push_back(config.duration_s / 2.0);
}

SimulateSettings read_settings(const SimulateOptions& options) {
  SimulateSettings settings;
  settings.prefix = read_bus_options(options.settings, "").prefix;
  if (!options.settings.empty()) {
    std::string all;
    for (const std::string& complaint :
         config::read_config(options.settings,
                             {config::shared_section("simulator", settings.simulation),
                              config::shared_section("cloud_assembler", settings.assembler)},
                             config::kTables))
      all += (all.empty() ? "" : "\n") + complaint;
    if (!all.empty()) throw std::runtime_error(all);
  }
  settings.simulation.scans = simulation::SimulationConfig::Scans::kLines;
  if (options.seconds > 0.0) settings.simulation.duration_s = options.seconds;
  if (options.still) stand_still(settings.simulation);
  if (settings.assembler.robot_boxes_m.empty())
    settings.assembler.robot_boxes_m = mask(settings.simulation.scanner.body);
  return settings;
}

std::int64_t utime_us(const simulation::SimulatedEvent& event) {
  return std::visit(
      [](const auto& e) {
        if constexpr (requires { e.measured; })
          return e.measured.utime_us;
        else if constexpr (requires { e.pose; })
          return e.pose.utime_us;
        else
          return e.utime_us;
      },
      event);
}

std::string summary(const SimulateOptions& options, const SimulatedLog::Counts& counts) {
  return fmt::format("{}: {} LASER and MIRROR, {} CLOUD, {} CLOUD_SLICE, {} ODOMETRY and TRUTH",
                     options.log.string(), counts.lines, counts.clouds, counts.slices,
                     counts.odometry);
}

int simulate(const SimulateOptions& options, Console& console) {
  const SimulateSettings settings = read_settings(options);
  simulation::SimulatedRun run(settings.simulation);
  FreshFile file(options.log);
  SimulatedLog log(file.path(), settings.prefix, run.scanner().config(), settings.assembler,
                   settings.simulation.perfect_deskew ? SimulatedLog::Deskew::kTruth
                                                      : SimulatedLog::Deskew::kWheels);
  {
    Progress progress(console, "simulating");
    while (!stop_requested()) {
      const auto event = run.next();
      if (!event) break;
      std::visit(log, *event);
      progress.show(static_cast<double>(utime_us(*event)) * 1e-6 / run.duration_s());
    }
  }
  log.close();
  return publish_or_keep_older(file, console, summary(options, log.counts()));
}

}  // namespace

void add_simulate(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "simulate",
      "Writes an LCM log of a simulated robot with a mirror scanner: LASER, MIRROR, CLOUD, "
      "CLOUD_SLICE, ODOMETRY, TRUTH.");
  const auto options = std::make_shared<SimulateOptions>();
  command->add_option("-o,--output", options->log, "the log to write; an old one is replaced")
      ->required();
  command->add_option("--config", options->settings,
                      "a robot's settings: tables [simulator] and [cloud_assembler]");
  command->add_option("--seconds", options->seconds, "how long; default as the settings say")
      ->check(CLI::Range(0.1, 86'400.0));
  command->add_flag("--still", options->still,
                    "stands in a room for a minute at two speeds of the mirror: for calibrate");
  command->footer(
      "Examples:\n"
      "  voxlist simulate -o run.lcmlog --seconds 60 && voxlist map run.lcmlog -o run_map\n"
      "  voxlist simulate --still -o room.lcm && voxlist calibrate room.lcm -o robot.toml");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return simulate(*options, console); };
  });
}

}  // namespace voxlist::desk
