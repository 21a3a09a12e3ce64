#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "voxlist/config/config.h"

namespace voxlist::bus {
class Bus;
class Health;
struct BusOptions;
}  // namespace voxlist::bus

namespace voxlist::service {

/// What a service is called (also its table in the settings file and its lock) and what it is for,
/// in one sentence for --help.
struct ServiceInfo {
  std::string name;
  std::string purpose;
  /// It has nothing to save: a second after it was asked to stop it ends, whatever it does.
  bool ends_within_work = false;
};

/// A service as the loop sees it.
class RunningService {
 public:
  virtual ~RunningService() = default;

  /// Called after messages and at least about every 20 ms. `now_us` starts as the wall clock and
  /// never jumps.
  virtual void tick(std::int64_t now_us) = 0;

  /// A descriptor that calls for tick() at once when it can be read; -1 when there is none now.
  virtual int wake_fd() const = 0;

  /// Called once before a wanted end. What it throws is told in HEALTH and makes the exit code 1.
  virtual void stop() = 0;
};

using MakeService = std::function<std::unique_ptr<RunningService>(bus::Bus&, bus::Health&)>;

/// Says why settings of the service do not fit together, or not to its bus; empty when they do. It
/// opens nothing.
using CheckSettings = std::function<std::string(const bus::BusOptions&)>;

/// Reads the command line and the settings, checks them, takes the service's lock, connects, makes
/// the service, and runs it until SIGTERM or SIGINT, or until a recording that is its bus has
/// ended. HEALTH goes out once a second. Returns the exit code: 0 after a wanted end, 1 with one
/// line on stderr when it cannot start or the service throws.
int run_service(int argc, char** argv, const ServiceInfo& info,
                const std::vector<config::Section>& settings, const CheckSettings& check,
                const MakeService& make);

/// What Service::check(config), or check(config, bus options), throws as std::invalid_argument;
/// empty when it throws nothing, or there is no such member.
template <class Service, class Config>
std::string why_invalid_for([[maybe_unused]] const Config& config,
                            [[maybe_unused]] const bus::BusOptions& bus) try {
  if constexpr (requires { Service::check(config, bus); }) Service::check(config, bus);
  if constexpr (requires { Service::check(config); }) Service::check(config);
  return {};
} catch (const std::invalid_argument& error) {
  return error.what();
}

/// The service's table, and the lists in no table that a member visit_root names, if there is one.
template <class Config>
std::vector<config::Section> sections_of(const std::string& name, Config& config) {
  std::vector<config::Section> sections = {config::section(name, config)};
  if constexpr (requires(config::SettingsVisitor & v) { config.visit_root(v); })
    sections.push_back({"", [&config](config::SettingsVisitor& v) { config.visit_root(v); }});
  return sections;
}

/// The main of a service: Service is made as Service(Bus&, Health&, const Config&) and may have
/// tick(now_us), stop(), and wake_fd() for a device that it reads in tick(). Its static
/// check(config), if it has one, throws std::invalid_argument for settings that its constructor
/// would refuse, and opens nothing: --check-config asks for it.
template <class Service, class Config>
int run_service(int argc, char** argv, const ServiceInfo& info) {
  struct Adapter : RunningService {
    Adapter(bus::Bus& bus, bus::Health& health, const Config& config)
        : service(bus, health, config) {}
    void tick([[maybe_unused]] std::int64_t now_us) override {
      if constexpr (requires(Service & s) { s.tick(now_us); }) service.tick(now_us);
    }
    int wake_fd() const override {
      if constexpr (requires(const Service& s) { s.wake_fd(); }) return service.wake_fd();
      return -1;
    }
    void stop() override {
      if constexpr (requires(Service & s) { s.stop(); }) service.stop();
    }
    Service service;
  };
  Config config;
  return run_service(
      argc, argv, info, sections_of(info.name, config),
      [&](const bus::BusOptions& bus) { return why_invalid_for<Service>(config, bus); },
      [&](bus::Bus& bus, bus::Health& health) {
        return std::make_unique<Adapter>(bus, health, config);
      });
}

}  // namespace voxlist::service
