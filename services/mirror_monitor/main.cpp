#include "service/service.h"
#include "services/mirror_monitor/mirror_monitor_service.h"

int main(int argc, char** argv) {
  using namespace voxlist;
  return run_service<MirrorMonitorService, MirrorMonitorConfig>(
      argc, argv,
      {"mirror_monitor",
       "Tells where the scanner's mirror is, from its clock and its blocking arms."});
}
