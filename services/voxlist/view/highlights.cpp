#include "services/voxlist/view/highlights.h"

#include <map>
#include <nlohmann/json.hpp>
#include <voxlist/health_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_update_t.hpp>

#include "services/voxlist/output/stop.h"

namespace voxlist::desk {
namespace {

class Reader {
 public:
  void take(const bus::Event& event) {
    if (found_.begin_us == 0) found_.begin_us = event.utime_us;
    found_.end_us = std::max(found_.end_us, event.utime_us);
    take_as<localisation_t>(bus::kLocalisation.name, event);
    take_as<map_update_t>(bus::kMapUpdate.name, event);
    take_as<health_t>(bus::kHealth.name, event);
  }

  Highlights finish() {
    if (is_lost_) found_.lost.back().to_us = found_.end_us;
    return found_;
  }

 private:
  template <class M>
  void take_as(const char* channel, const bus::Event& event) {
    M message{};
    if (event.channel == channel && bus::decode(event.bytes, message) == bus::Fault::kNone)
      note(message, event.utime_us);
  }

  void note(const localisation_t& message, std::int64_t utime_us) {
    const bool is_lost = message.state == localisation_t::STATE_LOST;
    if (is_lost && !is_lost_) found_.lost.push_back({utime_us, utime_us});
    if (is_lost_) found_.lost.back().to_us = utime_us;
    is_lost_ = is_lost;
  }

  void note(const map_update_t& message, std::int64_t utime_us) {
    found_.has_map |= message.n_blocks > 0;
    if (message.moves > moves_) found_.loops.push_back(utime_us);
    moves_ = message.moves;
  }

  void note(const health_t& message, std::int64_t utime_us) {
    std::int32_t& state = states_[message.service];
    if (message.state > state) found_.warnings.push_back(utime_us);
    state = message.state;
  }

  Highlights found_;
  bool is_lost_ = false;
  std::int64_t moves_ = 0;
  std::map<std::string, std::int32_t> states_;
};

}  // namespace

std::string Highlights::json(const std::string& name) const {
  nlohmann::json spans = nlohmann::json::array();
  for (const Span& span : lost) spans.push_back({span.from_us, span.to_us});
  return nlohmann::json({{"name", name},
                         {"begin_us", begin_us},
                         {"end_us", end_us},
                         {"lost", spans},
                         {"loop", loops},
                         {"warning", warnings}})
      .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Highlights highlights_of(Events& events) {
  Reader reader;
  while (const auto event = events.next()) {
    if (stop_requested()) break;
    reader.take(*event);
  }
  events.rewind();
  return reader.finish();
}

}  // namespace voxlist::desk
