#pragma once

#include "voxlist/geometry/mirror_state.h"
#include "voxlist/scanner/mirror/mirror_evidence.h"
#include "voxlist/scanner/mirror/mirror_trouble.h"

namespace voxlist::scanner {

/// Where the mirror is, and what is wrong with it.
struct MirrorAnswer {
  MirrorState state;  ///< all but the half turns
  MirrorTrouble trouble = MirrorTrouble::kNone;
};

/// Answers by the mirror's clock or by its arms, whichever knows the angle better.
MirrorAnswer mirror_answer(const MirrorEvidence& evidence);

}  // namespace voxlist::scanner
