#include "voxlist/system/version.h"

#include <voxlist_commit.h>

namespace voxlist {

std::string version() {
  const std::string commit = VOXLIST_COMMIT;
  return commit.empty() ? VOXLIST_NUMBER : VOXLIST_NUMBER " (" + commit + ")";
}

}  // namespace voxlist
