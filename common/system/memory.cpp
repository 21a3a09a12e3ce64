#include "voxlist/system/memory.h"

#include <malloc.h>
#include <unistd.h>

#include <fstream>

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

void give_memory_back() { ::malloc_trim(0); }

std::int64_t memory_of_process() {
  std::ifstream file("/proc/self/statm");
  std::int64_t whole_pages = 0, held_pages = 0;
  file >> whole_pages >> held_pages;
  return file ? held_pages * ::sysconf(_SC_PAGE_SIZE) : 0;
}

}  // namespace voxlist
