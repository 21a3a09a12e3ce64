#include "bench/report.h"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "bench/scene.h"

namespace voxlist {
namespace {

std::string machine() {
  std::ifstream cpus("/proc/cpuinfo");
  std::string model = "unknown";
  for (std::string line; std::getline(cpus, line);) {
    if (line.starts_with("model name")) {
      model = line.substr(line.find(':') + 2);
      break;
    }
  }
  return model + " x" + std::to_string(std::thread::hardware_concurrency());
}

std::string commit() {
  const std::unique_ptr<FILE, int (*)(FILE*)> git(
      popen("git -C '" VOXLIST_SOURCE_DIR "' describe --always --dirty 2>/dev/null", "r"), pclose);
  std::array<char, 64> line{};
  if (!git || !std::fgets(line.data(), line.size(), git.get())) return "unknown";
  const std::string text(line.data());
  return text.substr(0, text.find('\n'));
}

// Takes --csv FILE out of the arguments.
std::optional<std::string> take_csv_option(int& argc, char** argv) {
  for (int i = 1; i + 1 < argc; ++i) {
    if (std::string_view(argv[i]) != "--csv") continue;
    std::string file = argv[i + 1];
    for (int k = i; k + 2 < argc; ++k) argv[k] = argv[k + 2];
    argc -= 2;
    return file;
  }
  return std::nullopt;
}

}  // namespace

Report::Report() : ConsoleReporter(isatty(STDOUT_FILENO) ? OO_Defaults : OO_Tabular) {}

void Report::ReportRuns(const std::vector<Run>& runs) {
  ConsoleReporter::ReportRuns(runs);
  for (const Run& run : runs) {
    const std::string name = run.run_name.function_name;
    measures_.push_back(
        {name, "seconds", run.real_accumulated_time / static_cast<double>(run.iterations)});
    for (const auto& [counter, value] : run.counters)
      measures_.push_back({name, counter, value.value});
  }
}

void Report::ratio(const std::string& a, const std::string& b, const std::string& name) {
  if (const Measure* below = find(b, name)) ratio_to(below->value, b, a, name);
}

void Report::ratio_to(double reference, const std::string& source, const std::string& benchmark,
                      const std::string& name) {
  const Measure* measure = find(benchmark, name);
  if (!measure) return;
  const double value = measure->value / reference;
  std::printf("%s: %s / %s = %.3g\n", name.c_str(), benchmark.c_str(), source.c_str(), value);
  measures_.push_back({benchmark + " over " + source, name, value});
}

void Report::append_csv(const std::string& file, const std::string& program,
                        const std::string& scene) const {
  const bool fresh = !std::filesystem::exists(file);
  std::ofstream out(file, std::ios::app);
  if (fresh) out << "program,scene,benchmark,measure,value,machine,commit\n";
  const std::string where = ',' + machine() + ',' + commit() + '\n';
  for (const Measure& m : measures_) {
    out << program << ',' << scene << ',' << m.benchmark << ',' << m.name << ',' << m.value
        << where;
  }
  if (!out.flush()) throw std::runtime_error("cannot write " + file);
}

const Measure* Report::find(const std::string& benchmark, const std::string& name) const {
  for (const Measure& m : measures_) {
    if (m.benchmark == benchmark && m.name == name) return &m;
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
    if (csv)
      report.append_csv(*csv, std::filesystem::path(argv[0]).filename().string(), scene().name);
  } catch (const std::exception& error) {
    std::cerr << argv[0] << ": " << error.what() << '\n';
    return 1;
  }
  return 0;
}

}  // namespace voxlist
