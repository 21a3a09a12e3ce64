#include "services/voxlist/commands/desk.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/stop.h"
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

std::vector<std::string> names_of_commands(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

// CLI11 only says that a command is missing when the first word is none of them.
bool is_unknown_word(const CLI::App& program, const std::vector<std::string>& arguments) {
  return !arguments.empty() && !arguments.front().starts_with('-') &&
         std::ranges::count(names_of_commands(program), arguments.front()) == 0;
}

int tell_unknown_word(const CLI::App& program, const std::string& word, Console& console) {
  console.warn(fmt::format("\"{}\" is no command, it must be one of {}; see voxlist --help", word,
                           fmt::join(names_of_commands(program), ", ")));
  return static_cast<int>(CLI::ExitCodes::ExtrasError);
}

// An error in one line becomes exit code 1.
int run_command(const Command& command, Console& console) {
  try {
    return command(console);
  } catch (const std::bad_alloc&) {
    console.warn("out of memory, give it fewer or smaller scans");
  } catch (const std::exception& error) {
    console.warn(error.what());
  }
  return 1;
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
  add_extend(program, chosen);
  add_merge(program, chosen);
  add_rebuild(program, chosen);
  add_localise(program, chosen);
  add_localise_only(program, chosen);
  add_hint(program, chosen);
  add_listen(program, chosen);
  add_evaluate(program, chosen);
#ifdef VOXLIST_CALIBRATION
  add_report(program, chosen);
#endif
  add_edit(program, chosen);
  add_info(program, chosen);
  add_export(program, chosen);
  add_octomap(program, chosen);
  add_slice(program, chosen);
  add_view(program, chosen);
  add_simulate(program, chosen);
#ifdef VOXLIST_CALIBRATION
  add_calibrate(program, chosen);
#endif
  add_watch(program, chosen);
  add_health(program, chosen);
  add_play(program, chosen);
  add_bus(program, chosen);
  if (is_unknown_word(program, arguments))
    return tell_unknown_word(program, arguments.front(), console);
  try {
    std::ranges::reverse(arguments);  // as CLI11 wants them
    program.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    return explain(program, error, console);
  }
  const int exit_code = run_command(chosen, console);
  return stop_requested() ? kInterrupted : exit_code;
}

}  // namespace voxlist::desk
