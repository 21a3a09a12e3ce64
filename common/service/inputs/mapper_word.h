#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "voxlist/service/inputs/channel_check.h"

namespace voxlist {
class map_update_t;
}

namespace voxlist::service {

/// Which map the mapper has, by its own word: MAP_UPDATE is open to whoever publishes on it (a
/// recording that is played again, a second mapper, a program with a fault), so what it says of
/// another map, or of a version that does not follow, is asked about. Believed is what answers a
/// request of one's own. Where two mappers answer, the one that was believed stays so.
class MapperWord {
 public:
  struct Word {
    std::int64_t map_id;
    /// Keyframes in the map, how often they were moved, and how often it was edited by hand; 0: it
    /// is empty.
    std::int64_t version;
    std::int64_t moves = 0, edits = 0;

    std::int64_t keyframes() const { return version - moves - edits; }
  };

  /// `channel`: MAP_UPDATE, or another one that carries such messages of the mapper's.
  explicit MapperWord(bus::Health& health, std::string channel = "MAP_UPDATE");

  /// Looks at an update before anything else is done with it. False: leave it out. It makes no
  /// sense, or is not of the mapper's map, or of a version that the mapper is not known to have, or
  /// a whole map of another version than the last answer's.
  bool take(const map_update_t& update);

  /// Asks again.
  void doubt() { is_asking_ = true; }

  /// Believes what nobody has objected to, and tells HEALTH.
  void tick(std::int64_t now_us);

  /// The utime of the request to the mapper that is to be sent now, if one is.
  std::optional<std::int64_t> due(std::int64_t now_us);

  /// Nothing before the first answer.
  const std::optional<Word>& word() const { return word_; }

 private:
  bool refuse(const map_update_t& update);
  void take_answer(const Word& said);
  void take_rumour(const map_update_t& update);
  void settle(const Word& said);
  void note_two_mappers();

  bus::Health& health_;
  const std::string channel_;
  ChannelCheck check_;
  std::optional<Word> word_;
  std::int64_t answered_version_ = 0;
  bool is_asking_ = true;
  std::int64_t question_us_ = 0;  // utime of the last request, and of what answers it
  bool is_open_ = false;          // the request has been sent, and goes out again as it is
  std::optional<std::int64_t> last_asked_us_, unanswered_since_us_;
  // What another mapper has answered, while the one that is believed may still object.
  std::optional<Word> rival_;
  std::int64_t rival_since_us_ = 0;
  bool has_heard_of_another_ = false;
  std::int64_t now_us_ = 0;
};

}  // namespace voxlist::service
