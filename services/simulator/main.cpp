#include "services/simulator/simulator_service.h"
#include "voxlist/service/service.h"

int main(int argc, char** argv) {
  using namespace voxlist::services;
  return voxlist::service::run_service<SimulatorService, SimulatorConfig>(
      argc, argv,
      {"simulator",
       "Drives a simulated robot with a mirror scanner through a simulated building."});
}
