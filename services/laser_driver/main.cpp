#include "service/service.h"
#include "services/laser_driver/laser_driver_service.h"

int main(int argc, char** argv) {
  using namespace voxlist;
  return run_service<LaserDriverService, Lms200Config>(
      argc, argv, {"laser_driver", "Reads a SICK LMS 200 and publishes its lines."});
}
