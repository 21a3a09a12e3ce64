#include "services/viewer/viewer_service.h"
#include "voxlist/service/service.h"

int main(int argc, char** argv) {
  using namespace voxlist::services;
  return voxlist::service::run_service<ViewerService, ViewerServiceConfig>(
      argc, argv, {"viewer", "Serves the live page: map, robot, services, commands.", true});
}
