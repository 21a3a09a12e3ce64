#pragma once

#include <string>

#include "voxlist/scanner/mirror/mirror_evidence.h"
#include "voxlist/scanner/mirror/mirror_trouble.h"

namespace voxlist::scanner {

/// Why the angle is not known though the mirror may turn; never kNone.
MirrorTrouble why_searching(const MirrorEvidence& evidence);

/// What is wrong though the angle is known; kNone when nothing is.
MirrorTrouble fault(const MirrorEvidence& evidence);

/// The trouble as one line for a person, with the figures; empty for kNone. `evidence` is that
/// which the trouble was found in.
std::string sentence(MirrorTrouble trouble, const MirrorEvidence& evidence);

}  // namespace voxlist::scanner
