#include "services/octomap_export/octomap_export_service.h"
#include "voxlist/service/service.h"

int main(int argc, char** argv) {
  using namespace voxlist::services;
  return voxlist::service::run_service<OctomapExportService, OctomapExportConfig>(
      argc, argv, {"octomap_export", "Keeps the map as an OctoMap, on the bus and in files."});
}
