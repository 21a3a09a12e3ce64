#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <voxlist/health_t.hpp>
#include <voxlist/pose_hint_t.hpp>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/live/bus_options.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/geometry/angle.h"

namespace voxlist::desk {
namespace {

// HEALTH comes once a second; one may be lost.
constexpr int kTries = 12;
constexpr std::chrono::milliseconds kWait{250};

struct HintOptions {
  std::string config, url;
  double x_m = 0.0, y_m = 0.0, yaw_deg = 0.0, sigma_m = 0.5, sigma_yaw_deg = 15.0;
};

// What a localiser has done with hints since it was started.
struct HintCounts {
  std::int64_t taken = 0, refused = 0;
};

HintCounts counts_in(const health_t& health) {
  HintCounts counts;
  for (const counter_t& counter : health.counters) {
    if (counter.name == "POSE_HINT/taken")
      counts.taken += counter.count;
    else if (counter.name.starts_with("POSE_HINT/"))
      counts.refused += counter.count;
  }
  return counts;
}

pose_hint_t message_of(const HintOptions& options) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  pose_hint_t hint{};
  hint.utime = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
  hint.pose[0] = options.x_m;
  hint.pose[1] = options.y_m;
  hint.pose[2] = options.yaw_deg * kRadPerDeg;
  hint.sigma_m = options.sigma_m;
  hint.sigma_rad = options.sigma_yaw_deg * kRadPerDeg;
  return hint;
}

// Waits for the localiser's next word; nothing where none comes.
std::optional<HintCounts> next_counts(bus::Bus& bus, std::optional<HintCounts>& heard) {
  heard.reset();
  for (int i = 0; i < kTries && !heard && !stop_requested(); ++i) bus.handle(kWait);
  return heard;
}

int give_hint(const HintOptions& options, Console& console) {
  bus::Bus bus(read_bus_options(options.config, options.url));
  std::optional<HintCounts> heard;
  bus.subscribe(bus::kHealth, [&](const health_t& health) {
    if (health.service == "localiser") heard = counts_in(health);
  });
  const auto before = next_counts(bus, heard);
  if (!before) {
    console.warn("no localiser is heard on this bus: is it running?");
    return 1;
  }
  bus.publish(bus::kPoseHint, message_of(options));
  const auto after = next_counts(bus, heard);
  if (after && after->taken > before->taken) {
    console.say("the localiser looks there, too, and believes it only where its scans say so");
    return 0;
  }
  console.warn(after && after->refused > before->refused
                   ? "the localiser has no use for a hint: it is TRACKING, or has no map"
                   : "the hint was lost on its way, try again");
  return 3;
}

}  // namespace

void add_hint(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "hint", "Tells a running localiser where it may be, for it to look there, too.");
  const auto options = std::make_shared<HintOptions>();
  command->add_option("X", options->x_m, "in the map, m")->required();
  command->add_option("Y", options->y_m, "in the map, m")->required();
  command->add_option("YAW_DEG", options->yaw_deg, "where x looks in the map, deg")->required();
  command->add_option("--sigma", options->sigma_m, "standard deviation of X and Y, m")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 100.0));
  command->add_option("--sigma-yaw", options->sigma_yaw_deg, "standard deviation of YAW_DEG, deg")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 360.0));
  command->add_option("--config", options->config, "the robot's settings, for its table [bus]")
      ->check(CLI::ExistingFile);
  command->add_option("--lcm-url", options->url,
                      "the bus; default $LCM_DEFAULT_URL, else that of --config, else LCM's");
  command->footer("Example:\n  voxlist hint 12.5 -3 90 --sigma 1");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return give_hint(*options, console); };
  });
}

}  // namespace voxlist::desk
