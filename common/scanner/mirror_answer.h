#pragma once

#include "scanner/mirror_evidence.h"
#include "scanner/mirror_state.h"

namespace voxlist {

/// Says where the mirror is, by its clock or by its arms, whichever knows it better, and what is
/// wrong with it. All but the half turns.
MirrorState mirror_answer(const MirrorEvidence& evidence);

}  // namespace voxlist
