#include "services/mapper/edit_channel.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <voxlist/map_edit_t.hpp>
#include <voxlist/map_edits_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/multicast/paced_sender.h"

namespace voxlist::services {
namespace {

// Wishes whose answers are known when they come again.
constexpr std::size_t kAnswers = 64;

// Messages on MAP_EDITS that wait: at most 840 kB each.
constexpr std::int64_t kMostQueued = 4;

}  // namespace

EditChannel::EditChannel(bus::Bus& bus, bus::Health& health, bus::PacedSender& sender)
    : bus_(bus),
      health_(health),
      sender_(sender),
      check_(health, {.channel = "MAP_EDIT", .remedy = "", .is_needed = false}) {
  bus_.subscribe(bus::kMapEdit, [this](const map_edit_t& message) { take(message); });
}

void EditChannel::take(const map_edit_t& message) {
  const auto wish = bus::from_message(message);
  if (!wish) return refuse("it makes no sense");
  const bool waits = std::ranges::count(waiting_, wish->utime_us, &bus::EditWish::utime_us) > 0;
  if (waits) return;
  if (waiting_.size() == kMostWaiting) return health_.count("MAP_EDIT/queue_full");
  waiting_.push_back(*wish);
}

void EditChannel::refuse(const std::string& why) {
  health_.count("MAP_EDIT/refused");
  check_.note("refused", bus::Health::State::kWarning,
              fmt::format("a MAP_EDIT was refused: {}", why));
}

const EditChannel::Answer* EditChannel::answer_to(const bus::EditWish& wish) const {
  const auto found = std::ranges::find(answers_, wish.utime_us, &Answer::utime_us);
  return found == answers_.end() ? nullptr : &*found;
}

void EditChannel::tick(std::int64_t now_us,
                       const std::function<std::string(const bus::EditWish&)>& edit,
                       const std::function<bus::EditedBoxes()>& boxes) {
  check_.tick(now_us);
  if (waiting_.empty()) return;
  const bus::EditWish wish = std::move(waiting_.front());
  waiting_.pop_front();
  if (!answer_to(wish)) {
    answers_.push_back({wish.utime_us, edit(wish)});
    if (answers_.size() > kAnswers) answers_.pop_front();
    const std::string& refusal = answers_.back().refusal;
    refusal.empty() ? health_.count("edits") : refuse(refusal);
  }
  const Answer& answer = *answer_to(wish);
  if (answer.refusal.empty()) return tell(boxes(), wish.utime_us);
  map_edits_t message{};
  message.map_id = wish.map_id;
  message.answers = wish.utime_us;
  message.refusal = answer.refusal;
  push(std::move(message));
}

void EditChannel::tell(const bus::EditedBoxes& boxes, std::int64_t answers) {
  map_edits_t message = bus::to_message(boxes);
  message.answers = answers;
  push(std::move(message));
}

void EditChannel::push(map_edits_t message) {
  if (queued_ >= kMostQueued) return health_.count("MAP_EDITS/queue_full");
  const auto kept = std::make_shared<map_edits_t>(std::move(message));
  const bool queued =
      sender_.push_first(static_cast<std::size_t>(kept->getEncodedSize()), [this, kept] {
        bus_.publish(bus::kMapEdits, *kept);
        --queued_;
      });
  if (!queued) return health_.count("MAP_EDITS/queue_full");
  ++queued_;
}

}  // namespace voxlist::services
