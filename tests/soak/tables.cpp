#include "tests/soak/tables.h"

#include <fmt/core.h>

namespace voxlist::soak {
namespace {

double cpu_s(const Minute& of) {
  double sum_s = 0.0;
  for (const auto& [name, service] : of.services) sum_s += service.cpu_s;
  return sum_s;
}

double ms_per_second(double cpu_s, std::size_t minutes) {
  return cpu_s * 1e3 / (60.0 * static_cast<double>(minutes));
}

}  // namespace

std::string table_head(const Minute& of, const std::string& time_name) {
  std::string names, line = "|---|---|---|---|---|---|---|---|---|---|";
  for (const auto& [name, service] : of.services) {
    names += fmt::format(" {} |", name);
    line += "---|";
  }
  return fmt::format(
      "| {} | times real time | TRACKING, AMBIGUOUS, LOST, unanswered | wrong | error mm: median, "
      "max | answer ms: median, p99 | keyframes | lost | restarts | CPU ms a second |{}\n{}\n",
      time_name, names, line);
}

std::string table_row(const Minute& of, const std::string& time, std::size_t minutes) {
  std::int64_t lost = 0;
  int restarts = 0;
  std::string memory;
  for (const auto& [name, service] : of.services) {
    for (const auto& [counter, count] : service.lost) lost += count;
    restarts += service.restarts;
    memory += fmt::format(" {:.1f} |", service.memory_MB);
  }
  const Answers& a = of.answers;
  return fmt::format(
      "| {} | {:.0f} | {}, {}, {}, {} | {} | {:.0f}, {:.0f} | {:.1f}, {:.1f} | {} | "
      "{} | {} | {:.0f} |{}\n",
      time, 60.0 * static_cast<double>(minutes) / of.wall_s, a.tracking, a.ambiguous, a.lost,
      a.unanswered, a.wrong, percentile(a.error_mm, 50.0), percentile(a.error_mm, 100.0),
      percentile(a.answer_ms, 50.0), percentile(a.answer_ms, 99.0), of.keyframes, lost, restarts,
      ms_per_second(cpu_s(of), minutes), memory);
}

std::string service_table(const Minute& early, const Minute& late, std::size_t minutes) {
  std::string table =
      "| service | memory MB | CPU ms a second | latency ms, median | p99 "
      "|\n|---|---|---|---|---|\n";
  for (const auto& [name, was] : early.services) {
    const ServiceTime& is = late.services.at(name);
    table +=
        fmt::format("| {} | {:.2f}, {:.2f} | {:.1f}, {:.1f} | {:.2f}, {:.2f} | {:.1f}, {:.1f} |\n",
                    name, was.memory_MB, is.memory_MB, ms_per_second(was.cpu_s, minutes),
                    ms_per_second(is.cpu_s, minutes), was.latency_p50_ms, is.latency_p50_ms,
                    was.latency_p99_ms, is.latency_p99_ms);
  }
  return table;
}

std::string service_table(const Minute& of, std::size_t minutes) {
  return service_table(of, of, minutes);
}

std::string troubles_of(const Minute& of) {
  std::string all;
  for (const auto& [name, service] : of.services) {
    for (const auto& [counter, count] : service.lost)
      all += fmt::format("{} lost {} {}\n", name, count, counter);
    for (const auto& [trouble, count] : service.troubles)
      all += fmt::format("{} said {} times: {}\n", name, count, trouble);
  }
  return all;
}

}  // namespace voxlist::soak
