#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace voxlist::viewing {

/// One thing that a page shows, as it was last told.
struct Topic {
  std::string name;
  /// A JSON value.
  std::string json;
  /// What is too large for JSON; the topic's page code knows its form.
  std::vector<std::uint8_t> bytes;
  /// When it was told, by the clock of whoever put it there (us).
  std::int64_t told_us = 0;
};

/// The newest of everything but the map's blocks. A client is told with a number what it has seen,
/// so a slow one skips what is out of date, and costs no memory.
class Board {
 public:
  /// Most topics: names come from messages. More are left out.
  static constexpr std::size_t kMostTopics = 2000;

  /// Takes the place of what was told under this name.
  void put(const std::string& name, std::string json, std::int64_t now_us,
           std::vector<std::uint8_t> bytes = {});

  /// Forgets the topics whose names begin so. Whoever has seen them is not told.
  void drop(const std::string& prefix);

  /// Forgets all topics but one.
  void drop_all_but(const std::string& name);

  /// What was told first after `seen`, with its number; nothing is left out by who starts with 0.
  /// Null: nothing is new.
  struct Entry {
    std::int64_t number;
    const Topic* topic;
  };
  Entry next_after(std::int64_t seen) const;

 private:
  std::map<std::int64_t, Topic> by_number_;
  std::map<std::string, std::int64_t> numbers_;
  std::int64_t last_ = 0;
};

}  // namespace voxlist::viewing
