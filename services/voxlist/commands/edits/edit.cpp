#include <CLI/CLI.hpp>
#include <array>
#include <memory>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/commands/edits/folder_edit.h"
#include "services/voxlist/commands/edits/live_edit.h"

namespace voxlist::desk {
namespace {

struct Kind {
  EditKind kind;
  const char *name, *does;
};

constexpr std::array kKinds{
    Kind{EditKind::kErase, "erase",
         "Forgets what was hit in a box: it is unknown, or free where rays say so."},
    Kind{EditKind::kKeepFree, "free", "Keeps a box free, whatever is hit there."},
    Kind{EditKind::kKeepBlocked, "blocked",
         "Keeps a box occupied for planners, as a wall that no laser sees."}};

struct EditOptions {
  EditWish wish;
  LiveOptions live;
};

using Options = std::shared_ptr<EditOptions>;

void choose_edit(CLI::App& action, const Options& options, Command& chosen) {
  action.callback([options, &chosen] {
    chosen = [options](Console& console) {
      return options->live.wanted ? edit_live(options->wish, options->live, console)
                                  : edit_folder(options->wish, console);
    };
  });
}

void add_kind(CLI::App& command, const Kind& kind, const Options& options, Command& chosen) {
  CLI::App* action = command.add_subcommand(kind.name, kind.does);
  action
      ->add_option("CORNERS", options->wish.corners_m,
                   "x y z of a corner and of the one across (m)")
      ->required()
      ->expected(6);
  action->preparse_callback(
      [options, what = kind.kind](std::size_t) { options->wish.kind = what; });
  choose_edit(*action, options, chosen);
}

void add_remove(CLI::App& command, const Options& options, Command& chosen) {
  CLI::App* action = command.add_subcommand("remove", "Takes an edit back.");
  action->add_option("ID", options->wish.id, "its number, as list shows it")->required();
  choose_edit(*action, options, chosen);
}

void add_list(CLI::App& command, const Options& options, Command& chosen) {
  command.add_subcommand("list", "Lists the edits: number, kind, two corners, how loops moved it.")
      ->callback([options, &chosen] {
        chosen = [options](Console& console) { return list_edits(options->wish.folder, console); };
      });
}

void add_live(CLI::App& command, LiveOptions& live) {
  command.add_flag("--live", live.wanted, "have the mapper do it that works in the folder");
  command.add_option("--config", live.config, "the robot's settings, for its table [bus]")
      ->check(CLI::ExistingFile);
  command.add_option("--lcm-url", live.url,
                     "the bus; default $LCM_DEFAULT_URL, else that of --config, else LCM's");
}

}  // namespace

void add_edit(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "edit", "Erases boxes of a map by hand, or keeps them free or blocked, for good.");
  const auto options = std::make_shared<EditOptions>();
  command
      ->add_option("MAPDIR", options->wish.folder,
                   "map folder, as voxlist map or the mapper made it")
      ->required();
  add_live(*command, options->live);
  for (const Kind& kind : kKinds) add_kind(*command, kind, options, chosen);
  add_remove(*command, options, chosen);
  add_list(*command, options, chosen);
  command->require_subcommand(1);
  command->footer(
      "A box stays whatever is mapped later, and moves with the map where loops move it.\n"
      "Examples:\n"
      "  voxlist edit hall_map erase 2.0 -1.5 0.1 3.2 0.5 2.0\n"
      "  voxlist edit hall_map list\n"
      "  voxlist edit hall_map --live remove 1");
}

}  // namespace voxlist::desk
