#include "service/service.h"
#include "services/obstacle_detector/obstacle_detector_service.h"

int main(int argc, char** argv) {
  using namespace voxlist;
  return run_service<ObstacleDetectorService, ObstacleConfig>(
      argc, argv,
      {"obstacle_detector", "Tells the nearest obstacle in each bearing round the robot."});
}
