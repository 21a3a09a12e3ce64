#include "services/laser_driver/laser_driver_service.h"
#include "voxlist/service/service.h"

int main(int argc, char** argv) {
  using namespace voxlist::services;
  return voxlist::service::run_service<LaserDriverService, voxlist::scanner::Lms200Config>(
      argc, argv, {"laser_driver", "Reads a SICK LMS 200 and publishes its lines."});
}
