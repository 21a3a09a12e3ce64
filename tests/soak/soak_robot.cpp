// Plays a robot that drives laps through a simulated building to the services that run, as fast as
// they answer, and judges how they fare. Usage: soak_robot MINUTES PEOPLE SEED SERVICE...
// Writes a row for each minute of the robot's time, one for each hour, and the checks. Exit code 1
// when one of them failed, 2 when it could not begin.
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string>

#include "tests/soak/tables.h"
#include "tests/soak/verdict.h"

namespace {

using namespace voxlist::soak;

constexpr std::size_t kHour = 60;
volatile std::sig_atomic_t stopped = 0;

// A run that was stopped early is judged by what there was.
std::vector<Minute> drive(Robot& robot, std::size_t minutes) {
  std::vector<Minute> all;
  while (all.size() < minutes && stopped == 0) {
    all.push_back(robot.drive_minute());
    if (all.size() % 30 == 1) std::cout << table_head(all.back(), "minute");
    std::cout << table_row(all.back(), std::to_string(all.size()), 1) << troubles_of(all.back())
              << std::flush;
  }
  return all;
}

void tell_hours(const std::vector<Minute>& minutes) {
  const std::size_t hours = minutes.size() / kHour;
  if (hours == 0) return;
  std::cout << '\n' << table_head(minutes.front(), "hour");
  for (std::size_t hour = 0; hour < hours; ++hour)
    std::cout << table_row(sum(minutes, hour * kHour, (hour + 1) * kHour), std::to_string(hour + 1),
                           kHour);
  if (hours < 2) return;
  std::cout << "\nIn the second hour, and in the last:\n\n"
            << service_table(sum(minutes, kHour, 2 * kHour),
                             sum(minutes, (hours - 1) * kHour, hours * kHour), kHour);
}

bool tell_checks(const std::vector<Minute>& minutes) {
  bool all_kept = true;
  const Minute whole = sum(minutes, 0, minutes.size());
  std::cout << '\n' << service_table(whole, minutes.size()) << '\n' << troubles_of(whole) << '\n';
  for (const Check& check : judge(minutes)) {
    std::cout << (check.is_kept ? "ok: " : "FAILED: ") << check.claim << " (" << check.seen
              << ")\n";
    all_kept = all_kept && check.is_kept;
  }
  return all_kept;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::cerr << "usage: soak_robot MINUTES PEOPLE SEED SERVICE...\n";
    return 2;
  }
  const auto minutes = static_cast<std::size_t>(std::atol(argv[1]));
  LapsConfig config;
  config.people = std::atoi(argv[2]);
  config.seed = config.building_seed = std::atoi(argv[3]);
  std::signal(SIGINT, [](int) { stopped = 1; });
  std::signal(SIGTERM, [](int) { stopped = 1; });
  Robot robot(config, {argv + 4, argv + argc});
  if (!robot.meet_services(std::chrono::seconds(60))) {
    std::cerr << "soak_robot: not all services say HEALTH\n";
    return 2;
  }
  robot.settle();
  std::cerr << "soak_robot: the robot drives\n";
  const std::vector<Minute> all = drive(robot, minutes);
  if (all.empty()) return 2;
  tell_hours(all);
  return tell_checks(all) ? 0 : 1;
}
