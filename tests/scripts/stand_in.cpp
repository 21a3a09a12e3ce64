// Takes the place of any service: has its name, its table in the settings, its lock, and nothing to
// do.
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "voxlist/bus/health.h"
#include "voxlist/service/service.h"

namespace voxlist {
namespace {

struct StandInConfig {
  std::string farewell_file;
  std::string error;
  std::string engine = "search";

  template <class Visitor>
  void visit(Visitor& v) {
    v("farewell_file", farewell_file, "written on a wanted end");
    v("error", error, "what HEALTH says");
    v("engine", engine, "search; anything else is refused");
  }
};

class StandIn {
 public:
  StandIn(bus::Bus&, bus::Health& health, const StandInConfig& config) : config_(config) {
    health.raise("error", bus::Health::State::kError, config.error);
  }
  static void check(const StandInConfig& config) {
    if (config.engine != "search") throw std::invalid_argument("engine must be search");
  }
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
