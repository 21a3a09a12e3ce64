#include "voxlist/system/memory.h"

#include <unistd.h>

namespace voxlist {
namespace {

std::int64_t ask() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), page_bytes = ::sysconf(_SC_PAGE_SIZE);
  return pages > 0 && page_bytes > 0 ? std::int64_t{pages} * page_bytes : 1'000'000'000;
}

}  // namespace

std::int64_t memory_of_machine() {
  static const std::int64_t bytes = ask();
  return bytes;
}

}  // namespace voxlist
