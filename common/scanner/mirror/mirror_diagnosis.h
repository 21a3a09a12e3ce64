#pragma once

#include <string>

#include "voxlist/scanner/mirror/mirror_evidence.h"

namespace voxlist::scanner {

/// Why the angle is not known though the mirror may turn.
std::string why_searching(const MirrorEvidence& evidence);

/// What is wrong though the angle is known; empty when nothing is.
std::string what_is_wrong(const MirrorEvidence& evidence);

/// For how long a mirror has stood; only of one that stands.
std::string how_it_stands(const MirrorEvidence& evidence);

}  // namespace voxlist::scanner
