#include <CLI/CLI.hpp>
#include <memory>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/progress.h"
#include "services/voxlist/output/stop.h"
#include "services/voxlist/report/page/page.h"
#include "services/voxlist/report/paper/paper_report.h"
#include "services/voxlist/report/run/map_report.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"

namespace voxlist::desk {
namespace {

struct ReportOptions {
  std::filesystem::path folder;
  PaperOptions paper;
  std::filesystem::path map;
  std::filesystem::path truth;
};

Report measured(const ReportOptions& options, Console& console) {
  if (!options.map.empty()) return map_report(options.map, options.truth, console);
  Progress progress(console, "measuring");
  return paper_report(options.paper, [&](double share) { progress.show(share); });
}

std::filesystem::path made(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (!std::filesystem::is_directory(folder, failure))
    throw io::FileError(folder, "cannot be made a folder, check the name and its permissions");
  return folder;
}

int run(const ReportOptions& options, Console& console) {
  const std::filesystem::path page = made(options.folder) / "index.html";
  const Report report = measured(options, console);
  if (stop_requested()) {
    console.warn("interrupted: " + page.string() + " is as it was");
    return kInterrupted;
  }
  io::write_file_atomically(page, html_of(report));
  console.say(page.string());
  return 0;
}

}  // namespace

void add_report(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "report",
      "Measures the paper's figures anew and writes them beside the paper's values, or tells of "
      "one's own run: one page of HTML.");
  const auto options = std::make_shared<ReportOptions>();
  command
      ->add_option("-o,--output", options->folder,
                   "folder for index.html, which needs no other file")
      ->required();
  command->add_option("--seed", options->paper.seed, "of buildings, tours and scans; default 1")
      ->check(CLI::Range(1, 1'000'000));
  command->add_option("--only", options->paper.only,
                      "this figure alone, by its name in the page (fig-6); may be given again");
  command->add_flag("--quick", options->paper.quick,
                    "a few scans for each figure, to see that all is there: the page says so");
  CLI::Option* data = command->add_option(
      "--data", options->paper.data,
      "folder of recorded scans with poses.csv: the paper's measurements on them, too");
  CLI::Option* map = command->add_option("--map", options->map,
                                         "map folder of one's own run, instead of the paper");
  command
      ->add_option("--truth", options->truth,
                   "table of that run's true poses (poses.csv, or a file of TUM, KITTI or EuRoC)")
      ->needs(map);
  map->excludes(data);
  command->footer(
      "The same seed gives the same numbers, but for those that come from a clock.\n"
      "Examples:\n"
      "  voxlist report -o report --data hall\n"
      "  voxlist report -o report --map hall_map --truth hall/poses.csv");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return run(*options, console); };
  });
}

}  // namespace voxlist::desk
