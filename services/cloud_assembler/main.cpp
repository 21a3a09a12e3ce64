#include "services/cloud_assembler/cloud_assembler_service.h"
#include "voxlist/service/service.h"

int main(int argc, char** argv) {
  using namespace voxlist::services;
  return voxlist::service::run_service<CloudAssemblerService,
                                       voxlist::scanner::CloudAssemblerConfig>(
      argc, argv,
      {"cloud_assembler", "Makes 3D clouds of the laser's lines and the mirror's angle."});
}
