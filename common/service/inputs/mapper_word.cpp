#include "voxlist/service/inputs/mapper_word.h"

#include <fmt/core.h>

#include <utility>
#include <voxlist/map_update_t.hpp>

#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/bus/maps/map_faults.h"

namespace voxlist::service {
namespace {

using State = bus::Health::State;

// From one request to the next (us): an answer takes milliseconds, and where one packet of three is
// lost, both ways arrive every other time.
constexpr std::int64_t kAskPeriod_us = 250'000;

// Time (us) in which the mapper that is believed may say that it is still there, when another one
// answers.
constexpr std::int64_t kObjection_us = 300'000;

// No answer for so long (us) is told.
constexpr std::int64_t kSilence_us = 3'000'000;

}  // namespace

MapperWord::MapperWord(bus::Health& health, std::string channel)
    : health_(health),
      channel_(std::move(channel)),
      check_(health, {.channel = channel_, .remedy = "", .is_needed = false}) {}

bool MapperWord::take(const map_update_t& update) {
  if (refuse(update)) return false;
  if (question_us_ != 0 && update.answers == question_us_)
    take_answer({update.map_id, update.version, update.moves, update.edits});
  else
    take_rumour(update);
  const bool is_ours = word_ && word_->map_id == update.map_id;
  if (word_ && !is_ours) health_.count(channel_ + "/other_map");
  if (update.base_version == bus::kWholeMap) return is_ours && update.version == answered_version_;
  return is_ours && update.version <= word_->version;
}

bool MapperWord::refuse(const map_update_t& update) {
  const bus::MapFault fault = bus::fault_of(update);
  if (fault == bus::MapFault::kNone) return false;
  health_.count(channel_ + "/" + bus::name(fault));
  check_.note(bus::name(fault), State::kWarning,
              fmt::format("a {} {}, and was left out", channel_, bus::sentence(fault)));
  return true;
}

void MapperWord::take_answer(const Word& said) {
  const bool is_ours = !word_ || word_->map_id == said.map_id;
  if (!is_open_) {
    if (!is_ours) note_two_mappers();
    return;
  }
  if (is_ours) {
    if (rival_) note_two_mappers();
    if (has_heard_of_another_)
      check_.note("other_map", State::kWarning,
                  fmt::format("{0} of another map than the mapper's was left out: is a recording "
                              "played that has {0} in it?",
                              channel_));
    return settle(said);
  }
  if (!std::exchange(rival_, said)) rival_since_us_ = now_us_;
}

void MapperWord::take_rumour(const map_update_t& update) {
  if (!word_) return;
  if (update.map_id != word_->map_id) {
    has_heard_of_another_ = true;
    return doubt();
  }
  const bool is_whole = update.base_version == bus::kWholeMap;
  if (!is_whole && update.base_version == word_->version)
    word_ = {update.map_id, update.version, update.moves, update.edits};
  // The parts of a whole map may come after what was added to it meanwhile.
  if (update.version > word_->version || (update.version < word_->version && !is_whole)) doubt();
}

void MapperWord::settle(const Word& said) {
  word_ = said;
  answered_version_ = said.version;
  is_asking_ = is_open_ = has_heard_of_another_ = false;
  rival_.reset();
  unanswered_since_us_.reset();
}

void MapperWord::note_two_mappers() {
  check_.note("two_mappers", State::kError,
              "two mappers answer, and have different maps: stop one of them");
}

void MapperWord::tick(std::int64_t now_us) {
  now_us_ = now_us;
  if (rival_ && now_us - rival_since_us_ >= kObjection_us) {
    health_.count(channel_ + "/new_map");
    check_.note("new_map", State::kWarning,
                fmt::format("the mapper has another map now, of id {}: the one before was dropped",
                            rival_->map_id));
    settle(*rival_);
    last_asked_us_.reset();  // for the new map is asked at once
    doubt();
  }
  if (unanswered_since_us_ && now_us - *unanswered_since_us_ >= kSilence_us)
    check_.note("no_answer", State::kWarning, "the mapper does not answer: is it running?");
  check_.tick(now_us);
}

std::optional<std::int64_t> MapperWord::due(std::int64_t now_us) {
  if (!is_asking_) return std::nullopt;
  if (last_asked_us_ && now_us - *last_asked_us_ < kAskPeriod_us) return std::nullopt;
  last_asked_us_ = now_us;
  if (!std::exchange(is_open_, true)) question_us_ = now_us;
  if (!unanswered_since_us_) unanswered_since_us_ = now_us;
  return question_us_;
}

}  // namespace voxlist::service
