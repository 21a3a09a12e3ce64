#pragma once

#include <vector>

#include "voxlist/system/instructions.h"

namespace voxlist {

/// All instructions that this processor has.
inline std::vector<Instructions> instruction_sets() {
  std::vector<Instructions> sets{Instructions::kPortable};
  if (best_instructions() >= Instructions::kAvx2) sets.push_back(Instructions::kAvx2);
  if (best_instructions() >= Instructions::kAvx512) sets.push_back(Instructions::kAvx512);
  return sets;
}

}  // namespace voxlist
