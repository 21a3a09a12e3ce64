#include "services/voxlist/report/paper/paper_report.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "services/voxlist/output/stop.h"
#include "services/voxlist/report/paper/figures.h"
#include "services/voxlist/report/paper/real_scans.h"
#include "voxlist/io/files/file.h"
#include "voxlist/system/version.h"

namespace voxlist::desk {
namespace {

std::string command(const PaperOptions& options, const std::string& id) {
  std::string words = "voxlist report -o DIR";
  if (!id.empty()) words += " --only " + id;
  words += fmt::format(" --seed {}", options.seed);
  if (options.quick) words += " --quick";
  if (!options.data.empty()) words += " --data " + options.data.filename().string();
  return words;
}

std::string lead(const PaperOptions& options) {
  std::string text =
      "Every figure and claim of J. Ryde and H. Hu, \"Mobile Robot 3D Perception and Mapping with "
      "Multi-Resolution Occupancy Lists\", beside what Voxlist measures now. Orange is the "
      "paper's, "
      "blue is Voxlist's. A dagger beside a number: it comes from a clock, and differs from run to "
      "run; "
      "all other numbers are the same for the same seed.";
  if (options.quick)
    text +=
        " This is a quick run of a few scans for each figure: it shows that all is there, and its "
        "numbers tell little.";
  return text;
}

std::vector<std::string> all_ids() {
  std::vector<std::string> ids;
  for (const PaperFigure& figure : paper_figures()) ids.emplace_back(figure.id);
  ids.emplace_back(kRealScansId);
  return ids;
}

void check(const PaperOptions& options) {
  if (!options.data.empty() && !std::filesystem::is_directory(options.data))
    throw io::FileError(options.data, "is no folder, give the one that holds the recorded scans");
  const std::vector<std::string> ids = all_ids();
  for (const std::string& id : options.only) {
    if (std::ranges::count(ids, id) == 0)
      throw std::invalid_argument(
          fmt::format("--only {}: no such figure, there are {}", id, fmt::join(ids, ", ")));
    if (id == kRealScansId && options.data.empty())
      throw std::invalid_argument("--only real-scans: name the recorded scans with --data");
  }
}

bool wanted(const PaperOptions& options, const std::string& id) {
  return options.only.empty() || std::ranges::count(options.only, id) > 0;
}

Entry finished(Entry entry, const PaperOptions& options, const PaperFigure& figure) {
  entry.id = figure.id;
  entry.title = figure.title;
  if (entry.seeds.empty())
    entry.seeds =
        fmt::format("building and tour {0}, other scans {1}", options.seed, 4711 + options.seed);
  entry.command = command(options, figure.id);
  return entry;
}

}  // namespace

Report paper_report(const PaperOptions& options, const std::function<void(double)>& done) {
  using Clock = std::chrono::steady_clock;
  check(options);
  const Clock::time_point start = Clock::now();
  const Scene scene(options.seed, options.quick ? quick_scale() : ReportScale{});
  Report report{"The paper beside Voxlist", lead(options), {}, {}};
  const auto figures = paper_figures();
  for (std::size_t i = 0; i < figures.size() && !stop_requested(); ++i) {
    if (!wanted(options, figures[i].id)) continue;
    report.entries.push_back(finished(figures[i].measure(scene), options, figures[i]));
    done(static_cast<double>(i + 1) / static_cast<double>(figures.size() + 1));
  }
  if (!options.data.empty() && wanted(options, kRealScansId) && !stop_requested())
    report.entries.push_back(finished(real_scans(options.data, scene), options,
                                      {kRealScansId, kRealScansTitle, nullptr}));
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  report.facts = {{"Voxlist", version()},
                  {"seed", fmt::format("{}", options.seed)},
                  {"repeat", command(options, "")},
                  {"machine", timed(machine())},
                  {"measured in", timed(fmt::format("{:.0f} s", seconds))}};
  return report;
}

std::string machine() {
  std::ifstream cpus("/proc/cpuinfo");
  std::string model = "unknown";
  for (std::string line; std::getline(cpus, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos) {
      model = line.substr(line.find(": ") + 2);
      break;
    }
  return fmt::format("{}, {} cores", model, std::thread::hardware_concurrency());
}

}  // namespace voxlist::desk
