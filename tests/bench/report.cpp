#include "tests/bench/report.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <iostream>

namespace voxlist::bench {

Report::Report() : ConsoleReporter(isatty(STDOUT_FILENO) ? OO_Defaults : OO_Tabular) {}

void Report::ReportRuns(const std::vector<Run>& runs) {
  ConsoleReporter::ReportRuns(runs);
  for (const Run& run : runs) {
    const std::string &scene = run.report_label, &name = run.run_name.function_name;
    const double seconds = run.real_accumulated_time / static_cast<double>(run.iterations);
    figures_.push_back({scene, name, "seconds", seconds});
    for (const auto& [counter, value] : run.counters)
      figures_.push_back({scene, name, counter, value.value});
  }
}

void Report::ratio(const std::string& a, const std::string& b, const std::string& name) {
  if (const Figure* below = find(b, name)) ratio_to(below->value, b, a, name);
}

void Report::ratio_to(double reference, const std::string& source, const std::string& benchmark,
                      const std::string& name) {
  const Figure* measure = find(benchmark, name);
  if (!measure) return;
  const double value = measure->value / reference;
  std::printf("%s: %s / %s = %.3g\n", name.c_str(), benchmark.c_str(), source.c_str(), value);
  const std::string scene = measure->scene;
  figures_.push_back({scene, benchmark + " over " + source, name, value});
}

const Figure* Report::find(const std::string& benchmark, const std::string& name) const {
  for (const Figure& f : figures_) {
    if (f.benchmark == benchmark && f.measure == name) return &f;
  }
  return nullptr;
}

int run_benchmarks(int argc, char** argv, void (*add)(), void (*compare)(Report&)) {
  const auto csv = take_csv_option(argc, argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  try {
    add();
    Report report;
    benchmark::RunSpecifiedBenchmarks(&report);
    compare(report);
    if (csv) append_csv(*csv, std::filesystem::path(argv[0]).filename().string(), report.figures());
  } catch (const std::exception& error) {
    std::cerr << argv[0] << ": " << error.what() << '\n';
    return 1;
  }
  return 0;
}

}  // namespace voxlist::bench
