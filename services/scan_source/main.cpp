#include "services/scan_source/scan_source_service.h"
#include "voxlist/service/service.h"

int main(int argc, char** argv) {
  using namespace voxlist::services;
  return voxlist::service::run_service<ScanSourceService, ScanSourceConfig>(
      argc, argv, {"scan_source", "Publishes a folder of PLY or PCD scans at their own times."});
}
