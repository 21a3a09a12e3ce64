#pragma once

#include <filesystem>

namespace voxlist::service {

/// The folder for what belongs to running processes (locks, sockets, supervisor's logs):
/// $VOXLIST_RUN_DIR, else $XDG_RUNTIME_DIR/voxlist, else /tmp/voxlist-UID; made if it is not there.
/// Throws std::runtime_error if it cannot be made or belongs to another user. scripts/lib.sh names
/// the same folder.
std::filesystem::path run_folder();

}  // namespace voxlist::service
