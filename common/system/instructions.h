#pragma once

namespace voxlist {

/// Which instructions are used, from the plainest on; all give the same results.
enum class Instructions { kPortable, kAvx2, kAvx512 };

/// The fastest that this processor has, or slower ones that VOXLIST_INSTRUCTIONS names (portable,
/// avx2): a test compares what each makes.
Instructions best_instructions();

}  // namespace voxlist
