#include "voxlist/system/instructions.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace voxlist {
namespace {

Instructions fastest() {
  const bool has_512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                       __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
  if (has_512) return Instructions::kAvx512;
  return __builtin_cpu_supports("avx2") ? Instructions::kAvx2 : Instructions::kPortable;
}

Instructions most_wanted() {
  const char* name = std::getenv("VOXLIST_INSTRUCTIONS");
  const std::string_view wanted = name == nullptr ? "" : name;
  if (wanted == "portable") return Instructions::kPortable;
  return wanted == "avx2" ? Instructions::kAvx2 : Instructions::kAvx512;
}

}  // namespace

Instructions best_instructions() {
  static const Instructions best = std::min(fastest(), most_wanted());
  return best;
}

}  // namespace voxlist
