#pragma once

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
};

}  // namespace voxlist::config
