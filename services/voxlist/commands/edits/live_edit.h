#pragma once

#include <string>

#include "services/voxlist/commands/edits/edit_wish.h"

namespace voxlist::desk {

class Console;

/// Where the running mapper is.
struct LiveOptions {
  bool wanted = false;
  std::string config, url;
};

/// Has the running mapper edit the folder's map. Throws FileError where there is no map.
int edit_live(const EditWish& wish, const LiveOptions& live, Console& console);

}  // namespace voxlist::desk
