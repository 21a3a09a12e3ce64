#include "service/service.h"
#include "services/cloud_assembler/cloud_assembler_service.h"

int main(int argc, char** argv) {
  using namespace voxlist;
  return run_service<CloudAssemblerService, CloudAssemblerConfig>(
      argc, argv,
      {"cloud_assembler", "Makes 3D clouds of the laser's lines and the mirror's angle."});
}
