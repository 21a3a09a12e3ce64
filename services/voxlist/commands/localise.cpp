#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/commands/settings.h"
#include "services/voxlist/maps/stored_map.h"
#include "services/voxlist/output/fresh_file.h"
#include "services/voxlist/output/progress.h"
#include "services/voxlist/output/stop.h"
#include "services/voxlist/recording/scan_input.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"

namespace voxlist::desk {
namespace {

struct LocaliseOptions {
  std::filesystem::path map;
  std::filesystem::path input;
  std::filesystem::path result;
  std::filesystem::path config;
  PrefixOption prefix;
  std::optional<TiltUse> tilt;
  std::vector<double> match_heights_m;
};

// One scan's answer, and what it cost.
struct Located {
  std::int64_t number;
  matching::Localisation localisation;
  double elapsed_ms;
};

constexpr auto kHeader = "index,state,x_m,y_m,yaw_rad,overlap,confidence,elapsed_ms";
constexpr auto kTiltHeader = ",z_m,roll_rad,pitch_rad";

std::string row(const Located& located) {
  const matching::Localisation& found = located.localisation;
  std::string pose = ",,";
  double overlap_ratio = 0.0;
  if (!found.modes.empty()) {
    const Pose2& best = found.modes.front().T_map_base;
    pose = fmt::format("{:.6f},{:.6f},{:.9f}", best.x_m, best.y_m, best.yaw_rad);
    overlap_ratio = found.modes.front().overlap_ratio;
  }
  return fmt::format("{},{},{},{:.6f},{:.6f},{:.3f}", located.number, name(found.state), pose,
                     overlap_ratio, found.confidence, located.elapsed_ms);
}

std::string tilt_of(const Located& located) {
  if (located.localisation.modes.empty()) return ",,,";
  const Tilt& tilt = located.localisation.modes.front().tilt;
  return fmt::format(",{:.6f},{:.9f},{:.9f}", tilt.z_m, tilt.roll_rad, tilt.pitch_rad);
}

std::string table_of(const std::vector<Located>& results, bool with_tilt) {
  std::string table = kHeader + std::string(with_tilt ? kTiltHeader : "") + "\n";
  for (const Located& located : results)
    table += row(located) + (with_tilt ? tilt_of(located) : "") + "\n";
  return table;
}

Located locate(matching::Localiser& localiser, const Scan& scan) {
  const auto start = std::chrono::steady_clock::now();
  matching::Localisation found = localiser.locate(scan.cloud);
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - start;
  return {scan.number, std::move(found), elapsed.count()};
}

std::vector<Located> locate_all(matching::Localiser& localiser, ScanInput& input,
                                Console& console) {
  std::vector<Located> results;
  Progress progress(console, "localising");
  while (const auto scan = input.next()) {
    results.push_back(locate(localiser, *scan));
    progress.show(input.progress());
  }
  return results;
}

std::string summary(const std::vector<Located>& results) {
  const auto count = [&](matching::LocalisationState state) {
    const auto is = [state](const Located& l) { return l.localisation.state == state; };
    return fmt::format("{} {}", std::ranges::count_if(results, is), name(state));
  };
  std::vector<double> times_ms;
  for (const Located& located : results) times_ms.push_back(located.elapsed_ms);
  std::ranges::sort(times_ms);
  std::string text = fmt::format(
      "{} scans: {}, {}, {}", results.size(), count(matching::LocalisationState::kTracking),
      count(matching::LocalisationState::kAmbiguous), count(matching::LocalisationState::kLost));
  if (times_ms.empty()) return text;
  return fmt::format("{}; a scan took {:.1f} ms (median), {:.1f} ms at most", text,
                     times_ms[times_ms.size() / 2], times_ms.back());
}

int localise(const LocaliseOptions& options, Console& console) {
  DeskSettings settings = read_settings(options.config);
  if (options.tilt) settings.localiser.tilt = *options.tilt;
  if (!options.match_heights_m.empty())
    settings.localiser.matcher.scan.match_heights_m = options.match_heights_m;
  FreshFile file(options.result);
  const StoredMap map = read_map(options.map, settings.mapper, console);
  matching::Localiser localiser(map.builder.map(), settings.localiser);
  ScanInput input(options.input, console, {}, options.prefix.of(options.config), settings.adapter);
  const std::vector<Located> results = locate_all(localiser, input, console);

  const bool with_tilt = settings.localiser.tilt != TiltUse::kPlanar;
  io::write_file_atomically(file.path(), table_of(results, with_tilt));
  if (!input.omissions().empty()) console.warn("left out: " + input.omissions().summary());
  console.say(summary(results));
  return publish_or_keep_older(file, console, options.result.string());
}

}  // namespace

void add_localise(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "localise", "Finds each scan in a map by itself: no guess, no memory of the scan before.");
  const auto options = std::make_shared<LocaliseOptions>();
  command->add_option("MAPDIR", options->map, "map folder, as voxlist map or the mapper made it")
      ->required();
  command->add_option("INPUT", options->input, "LCM log with CLOUD, or folder of scans")
      ->required();
  command->add_option("-o,--output", options->result, "the table to write (result.csv)")
      ->required();
  command->add_option("--config", options->config, "the robot's settings (services/robot.toml)");
  options->prefix.add_to(*command);
  add_tilt(*command, options->tilt);
  add_match_heights(*command, options->match_heights_m);
  command->footer(
      "Example:\n"
      "  voxlist localise hall_map second_visit -o result.csv");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return localise(*options, console); };
  });
}

}  // namespace voxlist::desk
