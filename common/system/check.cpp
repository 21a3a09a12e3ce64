#include "voxlist/system/check.h"

#include <cstdlib>
#include <iostream>

namespace voxlist {

void check_failed(std::string_view condition, std::string_view message, std::string_view file,
                  int line) {
  std::cerr << file << ':' << line << ": " << message << " (failed: " << condition << ')'
            << std::endl;
  std::abort();
}

}  // namespace voxlist
