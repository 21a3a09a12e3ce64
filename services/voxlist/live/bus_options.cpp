#include "services/voxlist/live/bus_options.h"

#include <cstdlib>
#include <stdexcept>

#include "voxlist/config/config.h"
#include "voxlist/config/tables.h"
#include "voxlist/service/command_line.h"

namespace voxlist::desk {

bus::BusOptions read_bus_options(const std::filesystem::path& file, const std::string& url) {
  bus::BusOptions options;
  std::string all;
  if (!file.empty()) {
    for (const std::string& complaint :
         config::read_config(file, {service::bus_section(options)}, config::kTables))
      all += (all.empty() ? "" : "\n") + complaint;
  }
  if (!all.empty()) throw std::runtime_error(all);
  const char* environment = std::getenv("LCM_DEFAULT_URL");
  if (environment != nullptr && *environment != '\0') options.url = environment;
  if (!url.empty()) options.url = url;
  return options;
}

}  // namespace voxlist::desk
