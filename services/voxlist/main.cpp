#include <unistd.h>

#include <iostream>

#include "services/voxlist/console.h"
#include "services/voxlist/desk.h"
#include "services/voxlist/stop.h"

int main(int argc, char** argv) {
  voxlist::stop_on_interrupt();
  voxlist::Console console(std::cout, std::cerr, isatty(STDERR_FILENO) == 1);
  return voxlist::run_desk({argv + 1, argv + argc}, console);
}
