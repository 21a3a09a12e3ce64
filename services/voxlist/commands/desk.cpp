#include "services/voxlist/commands/desk.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/output/console.h"
#include "voxlist/system/version.h"

namespace voxlist::desk {
namespace {

std::string without_last_newline(std::string text) {
  if (text.ends_with('\n')) text.pop_back();
  return text;
}

// --help and --version end the parsing as an exception, too; only wrong usage has an exit code.
int explain(const CLI::App& program, const CLI::ParseError& error, Console& console) {
  std::ostringstream out, err;
  const int exit_code = program.exit(error, out, err);
  if (!out.str().empty()) console.say(without_last_newline(out.str()));
  if (!err.str().empty()) console.warn(without_last_newline(err.str()));
  return exit_code;
}

}  // namespace

int run_desk(std::vector<std::string> arguments, Console& console) {
  CLI::App program("Maps from recorded 3D scans, at the desk: the services' own classes.",
                   "voxlist");
  program.set_version_flag("--version", version());
  program.require_subcommand(1);
  Command chosen;
  add_import(program, chosen);
  add_map(program, chosen);
  add_localise(program, chosen);
  add_evaluate(program, chosen);
  add_simulate(program, chosen);
#ifdef VOXLIST_CALIBRATION
  add_calibrate(program, chosen);
#endif
  add_watch(program, chosen);
  add_health(program, chosen);
  try {
    std::ranges::reverse(arguments);  // as CLI11 wants them
    program.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    return explain(program, error, console);
  }
  try {
    return chosen(console);
  } catch (const std::bad_alloc&) {
    console.warn("out of memory, give it fewer or smaller scans");
  } catch (const std::exception& error) {
    console.warn(error.what());
  }
  return 1;
}

}  // namespace voxlist::desk
