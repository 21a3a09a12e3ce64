#include "voxlist/service/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <iostream>

#include "voxlist/bus/bus.h"
#include "voxlist/config/tables.h"
#include "voxlist/system/version.h"

namespace voxlist::service {

config::Section bus_section(bus::BusOptions& options) {
  return {"bus", [&options](config::SettingsVisitor& v) {
            v("url", options.url,
              "LCM network; ttl=0 stays on this machine, ttl=1 on this network");
            v("prefix", options.prefix, "put before every channel name, to tell robots apart");
            v("receive_buffer_bytes", options.receive_buffer_bytes,
              "asked of the kernel; a large cloud must fit", 100'000, 1'000'000'000);
          }};
}

namespace {

// What no table of keys and ranges tells.
std::vector<std::string> complaints_of(const ServiceInfo& info, const std::string& file,
                                       const CheckSettings& check, const bus::BusOptions& bus) {
  const std::string place = file.empty() ? "" : file + ": ";
  std::vector<std::string> complaints;
  if (const std::string wrong = bus::why_invalid(bus); !wrong.empty())
    complaints.push_back(place + "[bus] " + wrong);
  if (const std::string wrong = check(bus); !wrong.empty())
    complaints.push_back(place + "[" + info.name + "] " + wrong);
  return complaints;
}

}  // namespace

std::optional<int> read_command_line(int argc, char** argv, const ServiceInfo& info,
                                     const std::vector<config::Section>& settings,
                                     const CheckSettings& check, bus::BusOptions& bus) {
  CLI::App app(info.purpose, info.name);
  std::string file;
  std::string url;
  bool print = false, check_only = false;
  app.add_option("--config", file,
                 "settings file (TOML); lists only what differs from the defaults");
  app.add_option("--lcm-url", url, "LCM network, before LCM_DEFAULT_URL and the settings file");
  app.add_flag("--print-config", print, "print the settings in force as TOML, and end");
  app.add_flag("--check-config", check_only,
               "tell all that is wrong with the settings, and end without having opened anything");
  app.set_version_flag("--version", version());
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return 0;
  } catch (const CLI::CallForVersion&) {
    std::cout << version() << '\n';
    return 0;
  } catch (const CLI::ParseError& error) {
    std::cerr << info.name << ": " << error.what() << "; see " << info.name << " --help\n";
    return 1;
  }

  std::vector<config::Section> sections = {bus_section(bus)};
  sections.insert(sections.end(), settings.begin(), settings.end());
  if (!file.empty()) {
    const auto complaints = config::read_config(file, sections, config::kTables);
    for (const std::string& complaint : complaints)
      std::cerr << info.name << ": " << complaint << '\n';
    if (!complaints.empty()) return 1;
  }
  if (const char* from_environment = std::getenv("LCM_DEFAULT_URL");
      from_environment && *from_environment) {
    bus.url = from_environment;
  }
  if (!url.empty()) bus.url = url;
  if (print) {
    std::cout << config::to_toml(sections) << std::flush;
    return 0;
  }
  const auto complaints = complaints_of(info, file, check, bus);
  for (const std::string& complaint : complaints)
    std::cerr << info.name << ": " << complaint << '\n';
  if (!complaints.empty()) return 1;
  return check_only ? std::optional(0) : std::nullopt;
}

}  // namespace voxlist::service
