#pragma once

#include <filesystem>

namespace voxlist {

/// The folder for what outlives a process (maps, recordings): $STATE_DIRECTORY, which systemd sets
/// for a unit, else $XDG_STATE_HOME/voxlist, else ~/.local/state/voxlist. Throws
/// std::runtime_error when the environment names none. scripts/lib.sh names the same folder.
std::filesystem::path state_folder();

/// A folder of the settings: relative ones lie in state_folder(), wherever the process was started.
/// Empty stays empty.
std::filesystem::path in_state_folder(const std::filesystem::path& folder);

}  // namespace voxlist
