#pragma once

#include "voxlist/geometry/mirror_state.h"
#include "voxlist/scanner/mirror/mirror_evidence.h"

namespace voxlist::scanner {

/// Says where the mirror is, by its clock or by its arms, whichever knows it better, and what is
/// wrong with it. All but the half turns.
MirrorState mirror_answer(const MirrorEvidence& evidence);

}  // namespace voxlist::scanner
