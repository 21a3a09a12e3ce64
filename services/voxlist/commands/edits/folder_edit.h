#pragma once

#include "services/voxlist/commands/edits/edit_wish.h"

namespace voxlist::desk {

class Console;

/// Edits a map folder that nobody works in. Throws FileError.
int edit_folder(const EditWish& wish, Console& console);

/// Lists a folder's edits.
int list_edits(const std::filesystem::path& folder, Console& console);

}  // namespace voxlist::desk
