#pragma once

#include <optional>
#include <string>
#include <vector>

namespace voxlist::bench {

/// One measured number.
struct Figure {
  std::string scene;      ///< where it was measured
  std::string benchmark;  ///< what ran
  std::string measure;    ///< what the number is, with its unit
  double value = 0.0;
};

/// CPU time of this process, all its threads (ms).
double cpu_ms();

/// The value that a share of the values, 0..1, do not exceed; 0 when there are none.
double percentile(std::vector<double> values, double share);

/// Shows figures on the terminal, in one line below a title.
void print(const std::string& title, const std::vector<Figure>& figures);

/// Takes --csv FILE out of a program's arguments.
std::optional<std::string> take_csv_option(int& argc, char** argv);

/// The processor's name and how many there are of it.
std::string machine();

/// Appends rows program,scene,benchmark,measure,value,machine,commit to a table, which it begins
/// where there is none. Throws std::runtime_error.
void append_csv(const std::string& file, const std::string& program,
                const std::vector<Figure>& figures);

}  // namespace voxlist::bench
