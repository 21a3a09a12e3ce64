#pragma once

#include <cstdint>
#include <random>
#include <string>

namespace voxlist::test {

/// Damages bytes as disks, networks and attackers do; the same seed gives the same damage on every
/// machine.
class Damage {
 public:
  explicit Damage(std::uint64_t seed) : random_(seed) {}

  /// A damaged copy: cut short, bytes flipped, stretches overwritten, removed or repeated, numbers
  /// of a text header made huge or negative, or nothing of the original left. Rarely the copy is as
  /// good as the original.
  std::string operator()(const std::string& valid);

 private:
  std::size_t below(std::size_t limit) { return limit == 0 ? 0 : random_() % limit; }
  char any_byte() { return static_cast<char>(random_() & 0xFF); }
  void damage_once(std::string& bytes);
  void change_number(std::string& bytes);

  std::mt19937_64 random_;
};

}  // namespace voxlist::test
