#include "tests/soak/verdict.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace voxlist::soak {
namespace {

constexpr std::size_t kHour = 60;  // minutes

// Hours in which growth after the first can be told from noise.
constexpr std::size_t kLeastHours = 3;

// As the issue of a service that runs for weeks is: flat, after what it has to learn.
constexpr double kMostGrowth_percent = 1.0;

double median_of_hour(const std::vector<double>& by_minute, std::size_t hour) {
  const auto begin = by_minute.begin() + static_cast<std::ptrdiff_t>(hour * kHour);
  return percentile({begin, begin + kHour}, 50.0);
}

std::vector<double> memory_of(const std::string& service, const std::vector<Minute>& minutes) {
  std::vector<double> memory_MB;
  for (const Minute& minute : minutes) memory_MB.push_back(minute.services.at(service).memory_MB);
  return memory_MB;
}

std::vector<Check> memory_checks(const std::vector<Minute>& minutes) {
  if (minutes.size() < kLeastHours * kHour)
    return {{"memory", true, fmt::format("not judged: less than {} hours", kLeastHours)}};
  std::vector<Check> checks;
  for (const auto& [name, service] : minutes.front().services) {
    const double growth = growth_percent_per_hour(memory_of(name, minutes)).value_or(0.0);
    checks.push_back({fmt::format("{}: memory grows by less than {} % an hour after the first",
                                  name, kMostGrowth_percent),
                      growth < kMostGrowth_percent, fmt::format("{:+.2f} % an hour", growth)});
  }
  return checks;
}

}  // namespace

std::optional<double> growth_percent_per_hour(const std::vector<double>& by_minute) {
  const std::size_t hours = by_minute.size() / kHour;
  if (hours < kLeastHours) return std::nullopt;
  const double second_MB = median_of_hour(by_minute, 1);
  const double last_MB = median_of_hour(by_minute, hours - 1);
  return 100.0 * (last_MB / second_MB - 1.0) / static_cast<double>(hours - 2);
}

Minute sum(const std::vector<Minute>& minutes, std::size_t from, std::size_t to) {
  Minute all;
  std::map<std::string, std::vector<double>> memory_MB, p50_ms, p99_ms;
  for (std::size_t i = from; i < to; ++i) {
    const Minute& minute = minutes[i];
    all.answers.add(minute.answers);
    all.wall_s += minute.wall_s;
    all.late += minute.late;
    all.keyframes = std::max(all.keyframes, minute.keyframes);
    for (const auto& [name, service] : minute.services) {
      ServiceTime& sums = all.services[name];
      sums.cpu_s += service.cpu_s;
      sums.healths += service.healths;
      sums.restarts += service.restarts;
      for (const auto& [counter, count] : service.lost) sums.lost[counter] += count;
      for (const auto& [trouble, count] : service.troubles) sums.troubles[trouble] += count;
      if (service.healths == 0) continue;
      memory_MB[name].push_back(service.memory_MB);
      p50_ms[name].push_back(service.latency_p50_ms);
      p99_ms[name].push_back(service.latency_p99_ms);
    }
  }
  for (auto& [name, service] : all.services) {
    service.memory_MB = percentile(memory_MB[name], 50.0);
    service.latency_p50_ms = percentile(p50_ms[name], 50.0);
    service.latency_p99_ms = percentile(p99_ms[name], 50.0);
  }
  return all;
}

std::vector<Check> judge(const std::vector<Minute>& minutes) {
  const Minute all = sum(minutes, 0, minutes.size());
  const Answers& answers = all.answers;
  int restarts = 0;
  std::int64_t lost = 0;
  for (const auto& [name, service] : all.services) {
    restarts += service.restarts;
    for (const auto& [counter, count] : service.lost) lost += count;
  }
  std::vector<Check> checks{
      {"clouds were placed", answers.tracking > 0,
       fmt::format("{} of {}", answers.tracking, answers.clouds())},
      {"no pose was claimed that is wrong", answers.wrong == 0, fmt::format("{}", answers.wrong)},
      {"every cloud was answered, and no service kept the robot waiting",
       answers.unanswered == 0 && all.late == 0,
       fmt::format("{} not, {} times", answers.unanswered, all.late)},
      {"no message was lost", lost == 0, fmt::format("{}", lost)},
      {"no service was started again", restarts == 0, fmt::format("{}", restarts)}};
  for (Check& check : memory_checks(minutes)) checks.push_back(std::move(check));
  return checks;
}

}  // namespace voxlist::soak
