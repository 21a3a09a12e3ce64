#pragma once

#include <termios.h>

#include <optional>

namespace voxlist::serial {

/// The system's code for a speed; nothing for one that it has no code for.
std::optional<speed_t> line_speed(int baud);

/// The other way round; 0 for a code of none of the speeds.
int baud_of(speed_t speed);

/// Sets a line's settings to bytes as they are: 8N1, no flow control, no modem lines, no echo.
void make_raw(termios& settings);

}  // namespace voxlist::serial
