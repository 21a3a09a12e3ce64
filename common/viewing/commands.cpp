#include "voxlist/viewing/commands.h"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace voxlist::viewing {
namespace {

using nlohmann::json;

// Numbers beyond this (m, and everything else) are no operator's.
constexpr double kMost = 1e6;

double number(const json& from, const char* key) {
  const double value = from.at(key).get<double>();
  if (!(std::abs(value) <= kMost)) throw std::out_of_range(key);
  return value;
}

double positive(const json& from, const char* key) {
  const double value = number(from, key);
  if (value <= 0.0) throw std::out_of_range(key);
  return value;
}

Eigen::Vector3d corner(const json& from, const char* key) {
  const json& values = from.at(key);
  if (values.size() != 3) throw std::out_of_range(key);
  Eigen::Vector3d p;
  for (int i = 0; i < 3; ++i) p(i) = values.at(static_cast<std::size_t>(i)).get<double>();
  if (!(p.array().abs() <= kMost).all()) throw std::out_of_range(key);
  return p;
}

EditKind kind_of(const std::string& name) {
  if (name == "erase") return EditKind::kErase;
  if (name == "free") return EditKind::kKeepFree;
  if (name == "blocked") return EditKind::kKeepBlocked;
  throw std::out_of_range("kind");
}

Command hint(const json& j) {
  return HintCommand{{number(j, "x_m"), number(j, "y_m"), number(j, "yaw_rad")},
                     positive(j, "sigma_m"),
                     positive(j, "sigma_rad")};
}

Command edit(const json& j) {
  const Eigen::AlignedBox3d box(corner(j, "lowest"), corner(j, "highest"));
  if (box.isEmpty()) throw std::out_of_range("box");
  return EditCommand{kind_of(j.at("kind").get<std::string>()), box};
}

Command play(const json& j) {
  const double speed = number(j, "speed");
  if (speed < 0.0 || speed > 100.0) throw std::out_of_range("speed");
  return PlayCommand{speed};
}

using Parse = Command (*)(const json&);
const std::map<std::string, Parse> kParsers = {
    {"hint", hint},
    {"save", [](const json&) -> Command { return SaveCommand{}; }},
    {"localise_only",
     [](const json& j) -> Command { return LocaliseOnlyCommand{j.at("on").get<bool>()}; }},
    {"edit", edit},
    {"remove_edit",
     [](const json& j) -> Command { return RemoveEditCommand{j.at("id").get<std::int64_t>()}; }},
    {"record", [](const json& j) -> Command { return RecordCommand{j.at("on").get<bool>()}; }},
    {"play", play},
    {"seek",
     [](const json& j) -> Command { return SeekCommand{j.at("utime_us").get<std::int64_t>()}; }},
};

}  // namespace

std::optional<Command> parse_command(const std::string& name, const std::string& text) try {
  const auto parser = kParsers.find(name);
  if (parser == kParsers.end()) return std::nullopt;
  return parser->second(json::parse(text));
} catch (const json::exception&) {
  return std::nullopt;
} catch (const std::out_of_range&) {
  return std::nullopt;
}

}  // namespace voxlist::viewing
