#include "services/localiser/localiser_service.h"
#include "voxlist/service/service.h"

int main(int argc, char** argv) {
  using namespace voxlist::services;
  return voxlist::service::run_service<LocaliserService, LocaliserServiceConfig>(
      argc, argv,
      {"localiser", "Finds the robot's pose in the map from each cloud, and says how sure it is.",
       true});
}
