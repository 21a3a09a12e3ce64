#pragma once

namespace voxlist::service {

/// From now on SIGTERM and SIGINT only ask to stop. With `within_work` the process ends a second
/// after that with exit code 0, whatever it does, unless the work has come to its end before: for
/// services that have nothing to save.
void stop_on_signals(bool within_work);

/// Whether somebody asked the process to stop. Long work asks between its pieces, several times a
/// second, and gives up.
bool stop_requested();

/// What a service that is still being made throws once it was asked to stop: the process ends as
/// wanted.
struct Stopped {};

/// The work has come to its end.
void work_is_done();

}  // namespace voxlist::service
