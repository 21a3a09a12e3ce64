#include "tests/bench/figures.h"

#include <time.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <thread>

namespace voxlist::bench {
namespace {

std::string commit() {
  const std::unique_ptr<FILE, int (*)(FILE*)> git(
      popen("git -C '" VOXLIST_SOURCE_DIR "' describe --always --dirty 2>/dev/null", "r"), pclose);
  std::array<char, 64> line{};
  if (!git || !std::fgets(line.data(), line.size(), git.get())) return "unknown";
  const std::string text(line.data());
  return text.substr(0, text.find('\n'));
}

// A field of the table; names may hold commas.
std::string quoted(const std::string& text) {
  return text.find(',') == std::string::npos ? text : '"' + text + '"';
}

}  // namespace

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void print(const std::string& title, const std::vector<Figure>& figures) {
  std::printf("%s\n   ", title.c_str());
  for (const Figure& f : figures) std::printf(" %s %.4g", f.measure.c_str(), f.value);
  std::printf("\n");
  std::fflush(stdout);
}

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

void append_csv(const std::string& file, const std::string& program,
                const std::vector<Figure>& figures) {
  const bool fresh = !std::filesystem::exists(file);
  std::ofstream out(file, std::ios::app);
  if (fresh) out << "program,scene,benchmark,measure,value,machine,commit\n";
  const std::string where = ',' + quoted(machine()) + ',' + commit() + '\n';
  for (const Figure& f : figures) {
    out << program << ',' << quoted(f.scene) << ',' << quoted(f.benchmark) << ','
        << quoted(f.measure) << ',' << f.value << where;
  }
  if (!out.flush()) throw std::runtime_error("cannot write " + file);
}

}  // namespace voxlist::bench
