#include "services/mirror_monitor/mirror_monitor_service.h"
#include "voxlist/service/service.h"

int main(int argc, char** argv) {
  using namespace voxlist::services;
  return voxlist::service::run_service<MirrorMonitorService, MirrorMonitorConfig>(
      argc, argv,
      {"mirror_monitor",
       "Tells where the scanner's mirror is, from its clock and its blocking arms."});
}
