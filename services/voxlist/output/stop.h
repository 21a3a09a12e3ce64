#pragma once

namespace voxlist::desk {

/// From now on the first Ctrl-C (or SIGTERM) only asks to stop; the second ends the program.
void stop_on_interrupt();

/// Whether somebody asked to stop: finish with what is there.
bool stop_requested();

/// Exit code of a command that was stopped, as a shell gives it.
inline constexpr int kInterrupted = 130;

}  // namespace voxlist::desk
