#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "voxlist/bus/maps/edit_convert.h"
#include "voxlist/service/inputs/channel_check.h"

namespace voxlist::bus {
class Bus;
class Health;
class PacedSender;
}  // namespace voxlist::bus

namespace voxlist::services {

/// Edits by hand on their channels: wishes come on MAP_EDIT and wait, each once however often it
/// comes; what became of them, and all boxes, is told on MAP_EDITS.
class EditChannel {
 public:
  /// Most wishes that wait. Who gets no answer sends his again.
  static constexpr std::size_t kMostWaiting = 16;

  /// All must outlive it. The sender may have other things to send.
  EditChannel(bus::Bus& bus, bus::Health& health, bus::PacedSender& sender);

  /// Does one wish at most: `edit` says why it cannot be, in a line for people, or nothing; `boxes`
  /// then tells all of them.
  void tick(std::int64_t now_us, const std::function<std::string(const bus::EditWish&)>& edit,
            const std::function<bus::EditedBoxes()>& boxes);

  /// Tells all boxes. `answers`: utime of what is answered; 0: nothing.
  void tell(const bus::EditedBoxes& boxes, std::int64_t answers);

  /// The sender was cleared.
  void clear() { queued_ = 0; }

 private:
  // What became of a wish; no refusal: it was done.
  struct Answer {
    std::int64_t utime_us;
    std::string refusal;
  };

  void take(const map_edit_t& message);
  const Answer* answer_to(const bus::EditWish& wish) const;
  void refuse(const std::string& why);
  void push(map_edits_t message);

  bus::Bus& bus_;
  bus::Health& health_;
  bus::PacedSender& sender_;
  service::ChannelCheck check_;
  std::deque<bus::EditWish> waiting_;
  std::deque<Answer> answers_;  // the newest
  std::int64_t queued_ = 0;
};

}  // namespace voxlist::services
