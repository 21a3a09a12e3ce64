#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace voxlist::config {

class SettingsVisitor;

/// A list of settings structs as a visitor sees it.
struct StructList {
  std::size_t size = 0;
  std::function<void(std::size_t)> resize;
  std::function<void(std::size_t, SettingsVisitor&)> visit;
  /// Visits one that has its defaults, for documents.
  std::function<void(SettingsVisitor&)> visit_default;
};

/// Sees every key of a settings struct once: its name in the file, the member, what it means, and
/// for numbers the range (both ends allowed; for vectors of every element).
///
/// A settings struct is plain members with their defaults and one function that names them:
///
///     struct MapperConfig {
///       double resolution_m = 0.05;
///       template <class Visitor>
///       void visit(Visitor& v) {
///         v("resolution_m", resolution_m, "voxel edge", 0.005, 1.0);
///       }
///     };
///
/// so that it needs no header of this folder. A member that is a vector of such structs is a list
/// of tables in the file, `[[TABLE.key]]`; it comes last. Reading, printing and documenting are
/// visitors.
class SettingsVisitor {
 public:
  virtual ~SettingsVisitor() = default;
  virtual void operator()(const char* key, bool& value, const char* doc) = 0;
  virtual void operator()(const char* key, int& value, const char* doc, int min, int max) = 0;
  virtual void operator()(const char* key, double& value, const char* doc, double min,
                          double max) = 0;
  virtual void operator()(const char* key, std::string& value, const char* doc) = 0;
  virtual void operator()(const char* key, std::vector<double>& value, const char* doc, double min,
                          double max) = 0;
  virtual void operator()(const char* key, std::vector<std::string>& value, const char* doc) = 0;

  /// An enum whose values 0, 1, ... have these names in the file.
  template <class Enum, std::size_t kNames>
  void operator()(const char* key, Enum& value, const std::array<const char*, kNames>& names,
                  const char* doc) {
    auto chosen = static_cast<std::size_t>(value);
    choice(key, chosen, names, doc);
    value = static_cast<Enum>(chosen);
  }

  /// A table for each element.
  template <class Settings>
  requires requires(Settings& settings, SettingsVisitor& v) { settings.visit(v); }
  void operator()(const char* key, std::vector<Settings>& values, const char* doc) {
    const auto visit_default = [](SettingsVisitor& v) { Settings{}.visit(v); };
    const auto visit = [&values](std::size_t i, SettingsVisitor& v) { values[i].visit(v); };
    const auto resize = [&values](std::size_t size) { values.resize(size); };
    tables(key, {values.size(), resize, visit, visit_default}, doc);
  }

 protected:
  virtual void tables(const char* key, const StructList& list, const char* doc) = 0;

  /// One of the names, by its number.
  virtual void choice(const char* key, std::size_t& chosen, std::span<const char* const> names,
                      const char* doc) = 0;
};

}  // namespace voxlist::config
