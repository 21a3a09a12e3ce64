// Writes the scene of tests/foreign as an event log. Usage: record_scene LOG
#include <cstdio>

#include "tests/foreign/scene.h"
#include "voxlist/bus/event_log.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: record_scene LOG\n", stderr);
    return 2;
  }
  voxlist::bus::EventLogWriter log(argv[1]);
  for (const auto& message : voxlist::test::scene())
    log.write(message.channel, message.utime_us, message.bytes);
  log.close();
}
