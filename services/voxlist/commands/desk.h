#pragma once

#include <string>
#include <vector>

namespace voxlist::desk {

class Console;

/// Runs the desk tool with these arguments (without the program's name). Returns the exit code: 0,
/// 1 after an error (told in one line), above 100 after wrong usage, kInterrupted after Ctrl-C.
int run_desk(std::vector<std::string> arguments, Console& console);

}  // namespace voxlist::desk
