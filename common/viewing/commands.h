#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "voxlist/geometry/pose.h"
#include "voxlist/voxels/edits/placed_box.h"

namespace voxlist::viewing {

// What an operator asks for on the page.

/// Where the operator thinks that the robot is: a place to look at first, never an order.
struct HintCommand {
  Pose2 pose;
  double sigma_m = 1.0, sigma_rad = 0.3;
};
struct SaveCommand {};
struct LocaliseOnlyCommand {
  bool on = true;
};
struct EditCommand {
  EditKind kind = EditKind::kErase;
  Eigen::AlignedBox3d box;
};
/// Takes an edit back.
struct RemoveEditCommand {
  std::int64_t id = 0;
};
struct RecordCommand {
  bool on = true;
};
/// Of a recording that is shown: plays at a speed (0: stands still), or goes to a time.
struct PlayCommand {
  double speed = 1.0;
};
struct SeekCommand {
  std::int64_t utime_us = 0;
};

using Command = std::variant<HintCommand, SaveCommand, LocaliseOnlyCommand, EditCommand,
                             RemoveEditCommand, RecordCommand, PlayCommand, SeekCommand>;

/// The command of a name ("hint", "save", "localise_only", "edit", "remove_edit", "record", "play",
/// "seek") with its JSON. Nothing: there is no such command, or the JSON does not say what it
/// needs.
std::optional<Command> parse_command(const std::string& name, const std::string& json);

}  // namespace voxlist::viewing
