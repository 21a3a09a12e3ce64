#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "tests/bench/figures.h"

namespace voxlist::bench {

/// Shows results on the terminal as Google Benchmark does, and keeps them for ratios and the CSV
/// file. A benchmark's label is its scene.
class Report : public benchmark::ConsoleReporter {
 public:
  /// Colours only on a terminal.
  Report();

  void ReportRuns(const std::vector<Run>& runs) override;

  /// Prints a's number over b's, both from this run, and keeps it as a measure of its own. Nothing
  /// when one of the two was not run.
  void ratio(const std::string& a, const std::string& b, const std::string& name);

  /// The same against a number from elsewhere, which `source` names.
  void ratio_to(double reference, const std::string& source, const std::string& benchmark,
                const std::string& name);

  /// What was measured, and the ratios.
  const std::vector<Figure>& figures() const { return figures_; }

 private:
  const Figure* find(const std::string& benchmark, const std::string& name) const;

  std::vector<Figure> figures_;
};

/// The main of a benchmark program: Google Benchmark's options and --csv FILE, then `add` registers
/// the benchmarks, they run, and `compare` prints ratios. Returns the exit code.
int run_benchmarks(int argc, char** argv, void (*add)(), void (*compare)(Report&));

}  // namespace voxlist::bench
