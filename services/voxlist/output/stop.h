#pragma once

namespace voxlist::desk {

/// From now on the first Ctrl-C (or SIGTERM) only asks to stop; the second ends the program. So
/// does the first, with kInterrupted, when the work at hand does not look at stop_requested()
/// within a second: files are written whole or not at all, so nothing is half there.
void stop_on_interrupt();

/// Whether somebody asked to stop: finish with what is there. Once it has said so, finishing may
/// take its time.
bool stop_requested();

/// Exit code of a command that was stopped, as a shell gives it.
inline constexpr int kInterrupted = 130;

}  // namespace voxlist::desk
