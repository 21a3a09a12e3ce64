#include "service/service.h"
#include "services/simulator/simulator_service.h"

int main(int argc, char** argv) {
  using namespace voxlist;
  return run_service<SimulatorService, SimulatorConfig>(
      argc, argv,
      {"simulator",
       "Drives a simulated robot with a mirror scanner through a simulated building."});
}
