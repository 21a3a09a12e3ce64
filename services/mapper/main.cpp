#include "service/service.h"
#include "services/mapper/mapper_service.h"

int main(int argc, char** argv) {
  using namespace voxlist;
  return run_service<MapperService, MapperServiceConfig>(
      argc, argv,
      {"mapper",
       "Builds the 3D map from clouds whose pose is sure, keeps it on disk, and serves it."});
}
