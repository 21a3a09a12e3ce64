#include "services/voxlist/commands/calibrate.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <stdexcept>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/recording/scanner_log.h"
#include "voxlist/calibration/calibrate.h"
#include "voxlist/config/edit.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"

namespace voxlist::desk {
namespace {

constexpr auto kTable = "cloud_assembler";

using Values = std::vector<std::pair<std::string, std::string>>;

// A value in the file's units.
std::string told(std::size_t parameter, double value) {
  const calibration::ParameterInfo& info = calibration::kParameterInfos[parameter];
  return fmt::format("{:.{}f}", value * info.file_units, info.decimals);
}

void tell(const calibration::CalibrationAnswer& answer, const calibration::ParameterVector& before,
          Console& console) {
  const auto row = [&](const std::string& name, const std::vector<std::string>& cells) {
    std::string line = fmt::format("{:22}", name);
    for (const std::string& cell : cells) line += fmt::format("{:>12}", cell);
    console.say(line);
  };
  row("parameter", {"before", "after", "sd"});
  for (std::size_t i = 0; i < calibration::kParameterInfos.size(); ++i) {
    const int k = static_cast<int>(i);
    row(calibration::kParameterInfos[i].key, {told(i, before[k]), told(i, answer.parameters[k]),
                                              answer.held[i] ? "held" : told(i, answer.sd[k])});
  }
  console.say(
      fmt::format("surfaces are {:.1f} mm thick before, {:.1f} mm after (RMS over {} surfaces; {} "
                  "beams of {} lines)",
                  answer.thickness_before_m * 1e3, answer.thickness_after_m * 1e3, answer.surfaces,
                  answer.beams, answer.lines));
}

Values values_of(const calibration::CalibrationAnswer& answer) {
  Values values;
  for (std::size_t i = 0; i < calibration::kParameterInfos.size(); ++i)
    if (!answer.held[i])
      values.emplace_back(calibration::kParameterInfos[i].key,
                          told(i, answer.parameters[static_cast<int>(i)]));
  return values;
}

int run(const CalibrateOptions& options, Console& console) {
  const scanner::CloudAssemblerConfig scanner = read_scanner_settings(options.settings());
  const calibration::Calibration result = calibration::calibrate(
      read_scanner_log(options.log, options.prefix.of(options.settings()), console), scanner, {});
  if (result.answer) tell(*result.answer, calibration::parameters_of(scanner.geometry), console);
  for (const std::string& warning : result.warnings) console.warn(warning);
  for (const std::string& refusal : result.refusals) console.warn("refused: " + refusal);
  if (!result.refusals.empty()) return 1;
  const auto edit = [&](const std::string& text) {
    return config::with_numbers(text, kTable, values_of(*result.answer));
  };
  give(options, "", edit, console);
  return 0;
}

std::string edited(const std::filesystem::path& file,
                   const std::function<std::string(const std::string&)>& edit) {
  try {
    return edit(file.empty() ? "" : io::read_file(file));
  } catch (const io::FileError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw io::FileError(file, error.what());
  }
}

}  // namespace

std::filesystem::path CalibrateOptions::settings() const {
  const bool updates = config.empty() && std::filesystem::exists(output);
  return updates ? output : config;
}

void give(const CalibrateOptions& options, const std::string& none,
          const std::function<std::string(const std::string&)>& edit, Console& console) {
  if (options.output.empty()) {
    std::string lines = edit(none);
    lines.pop_back();
    return console.say(lines);
  }
  io::write_file_atomically(options.output, edited(options.settings(), edit));
  console.say(options.output.string());
}

void add_calibrate(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "calibrate",
      "Finds the scanner's mirror phases, heights, tilts and latency from a minute of a still "
      "room; or a 3D laser's mount and latency from a drive.");
  const auto options = std::make_shared<CalibrateOptions>();
  command
      ->add_option(
          "LOG", options->log,
          "LCM log with LASER, MIRROR and ODOMETRY; with --laser: with the laser's channel "
          "and ODOMETRY")
      ->required();
  command->add_flag("--laser", options->laser,
                    "the mount of a 3D laser, a sensor of [cloud_adapter], from two minutes' drive "
                    "with turns on a level floor");
  command->add_option("--channel", options->channel, "which of several sensors");
  command->add_option("--config", options->config,
                      "the robot's settings to start from; default: those of -o, if there");
  command->add_option("-o,--output", options->output,
                      "the robot's settings to write; without it the lines are only shown");
  options->prefix.add_to(*command);
  command->footer(
      "Examples:\n"
      "  voxlist calibrate still.lcm -o services/robot.toml\n"
      "  voxlist calibrate --laser drive.lcm -o services/robot.toml");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) {
      return options->laser ? calibrate_laser(*options, console) : run(*options, console);
    };
  });
}

}  // namespace voxlist::desk
