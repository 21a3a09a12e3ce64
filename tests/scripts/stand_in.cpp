// Takes the place of any service: has its name, its table in the settings, its lock, and nothing to
// do.
#include <filesystem>
#include <fstream>

#include "voxlist/service/service.h"

namespace voxlist {
namespace {

struct StandInConfig {
  std::string farewell_file;

  template <class Visitor>
  void visit(Visitor& v) {
    v("farewell_file", farewell_file, "written on a wanted end");
  }
};

class StandIn {
 public:
  StandIn(bus::Bus&, bus::Health&, const StandInConfig& config) : config_(config) {}
  void stop() {
    if (!config_.farewell_file.empty()) std::ofstream(config_.farewell_file) << "saved\n";
  }

 private:
  StandInConfig config_;
};

}  // namespace
}  // namespace voxlist

int main(int argc, char** argv) {
  const std::string name = std::filesystem::path(argv[0]).filename();
  return voxlist::service::run_service<voxlist::StandIn, voxlist::StandInConfig>(
      argc, argv, {name, "Stands in for a service in tests."});
}
