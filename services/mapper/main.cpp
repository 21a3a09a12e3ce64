#include "services/mapper/mapper_service.h"
#include "voxlist/service/service.h"

int main(int argc, char** argv) {
  using namespace voxlist::services;
  return voxlist::service::run_service<MapperService, MapperServiceConfig>(
      argc, argv,
      {"mapper",
       "Builds the 3D map from clouds whose pose is sure, keeps it on disk, and serves it."});
}
