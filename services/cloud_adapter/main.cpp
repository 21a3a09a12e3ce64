#include "services/cloud_adapter/cloud_adapter_service.h"
#include "voxlist/service/service.h"

int main(int argc, char** argv) {
  using namespace voxlist::services;
  return voxlist::service::run_service<CloudAdapterService, voxlist::adapter::AdapterConfig>(
      argc, argv,
      {"cloud_adapter", "Makes CLOUD of what any 3D laser on any mount publishes.", true});
}
