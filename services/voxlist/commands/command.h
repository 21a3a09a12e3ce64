#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace voxlist::desk {

class Console;

/// What the command line asked for; returns the exit code.
using Command = std::function<int(Console&)>;

// One for each subcommand: adds it with its options to the program. When it is chosen, `chosen`
// becomes the command to run.
void add_import(CLI::App& program, Command& chosen);
void add_map(CLI::App& program, Command& chosen);
void add_extend(CLI::App& program, Command& chosen);
void add_merge(CLI::App& program, Command& chosen);
void add_rebuild(CLI::App& program, Command& chosen);
void add_localise(CLI::App& program, Command& chosen);
void add_localise_only(CLI::App& program, Command& chosen);
void add_hint(CLI::App& program, Command& chosen);
void add_listen(CLI::App& program, Command& chosen);
void add_evaluate(CLI::App& program, Command& chosen);
void add_report(CLI::App& program, Command& chosen);
void add_edit(CLI::App& program, Command& chosen);
void add_info(CLI::App& program, Command& chosen);
void add_export(CLI::App& program, Command& chosen);
void add_octomap(CLI::App& program, Command& chosen);
void add_slice(CLI::App& program, Command& chosen);
void add_view(CLI::App& program, Command& chosen);
void add_simulate(CLI::App& program, Command& chosen);
void add_calibrate(CLI::App& program, Command& chosen);
void add_watch(CLI::App& program, Command& chosen);
void add_health(CLI::App& program, Command& chosen);
void add_play(CLI::App& program, Command& chosen);
void add_bus(CLI::App& program, Command& chosen);

}  // namespace voxlist::desk
