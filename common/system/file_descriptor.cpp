#include "voxlist/system/file_descriptor.h"

#include <unistd.h>

namespace voxlist {

FileDescriptor::~FileDescriptor() {
  if (fd_ >= 0) ::close(fd_);
}

}  // namespace voxlist
