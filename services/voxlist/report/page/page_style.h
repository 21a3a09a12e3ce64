#pragma once

namespace voxlist::desk {

/// The style sheet of a report: light or dark as the reader's screen is, and fit for paper. Classes
/// of charts are those of Ink.
extern const char* const kPageStyle;

}  // namespace voxlist::desk
