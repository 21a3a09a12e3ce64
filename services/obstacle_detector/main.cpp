#include "services/obstacle_detector/obstacle_detector_service.h"
#include "voxlist/service/service.h"

int main(int argc, char** argv) {
  using namespace voxlist::services;
  return voxlist::service::run_service<ObstacleDetectorService, voxlist::planning::ObstacleConfig>(
      argc, argv,
      {"obstacle_detector", "Tells the nearest obstacle in each bearing round the robot.", true});
}
