#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

namespace voxlist::config {

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
/// so that it needs no header of this folder. Reading, printing and documenting are visitors.
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

 protected:
  /// One of the names, by its number.
  virtual void choice(const char* key, std::size_t& chosen, std::span<const char* const> names,
                      const char* doc) = 0;
};

}  // namespace voxlist::config
