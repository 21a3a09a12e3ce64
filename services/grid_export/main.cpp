#include "services/grid_export/grid_export_service.h"
#include "voxlist/service/service.h"

int main(int argc, char** argv) {
  using namespace voxlist::services;
  return voxlist::service::run_service<GridExportService, GridExportConfig>(
      argc, argv, {"grid_export", "Keeps the map as a floor plan for each robot, for planners."});
}
