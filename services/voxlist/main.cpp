#include <unistd.h>

#include <iostream>

#include "services/voxlist/commands/desk.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/stop.h"

int main(int argc, char** argv) {
  voxlist::desk::stop_on_interrupt();
  voxlist::desk::Console console(std::cout, std::cerr, isatty(STDERR_FILENO) == 1);
  return voxlist::desk::run_desk({argv + 1, argv + argc}, console);
}
