#include "voxlist/bus/maps/edit_convert.h"

#include <algorithm>
#include <array>
#include <voxlist/map_edit_t.hpp>
#include <voxlist/map_edits_t.hpp>

#include "voxlist/bus/convert.h"
#include "voxlist/voxels/edits/edit_limits.h"

namespace voxlist::bus {
namespace {

Eigen::AlignedBox3d box_between(const double (&lowest)[3], const double (&highest)[3]) {
  return {Eigen::Vector3d(lowest), Eigen::Vector3d(highest)};
}

void write(const Eigen::AlignedBox3d& box, double (&lowest)[3], double (&highest)[3]) {
  std::copy_n(box.min().data(), 3, lowest);
  std::copy_n(box.max().data(), 3, highest);
}

bool is_kind(std::int32_t action) {
  return action >= map_edit_t::ERASE && action <= map_edit_t::KEEP_BLOCKED;
}

// EditKind counts as the message does.
static_assert(static_cast<int>(EditKind::kKeepFree) == map_edit_t::KEEP_FREE &&
              static_cast<int>(EditKind::kKeepBlocked) == map_edit_t::KEEP_BLOCKED);

PlacedBox placed(const edited_box_t& m) {
  return {static_cast<EditKind>(m.kind),
          box_between(m.lowest, m.highest),
          {m.moved[0], m.moved[1], m.moved[2]}};
}

bool are_possible(const std::vector<edited_box_t>& messages) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const edited_box_t& m : messages) boxes.push_back(box_between(m.lowest, m.highest));
  return fault_of(boxes).empty() && std::ranges::all_of(messages, [](const edited_box_t& m) {
           return is_kind(m.kind) && is_sane_move(placed(m).T_map_box);
         });
}

}  // namespace

std::optional<EditWish> from_message(const map_edit_t& m) {
  const bool removes = m.action == map_edit_t::REMOVE;
  if (!is_sane_utime(m.utime) || !(removes || is_kind(m.action))) return std::nullopt;
  EditWish wish{m.utime, m.map_id, std::nullopt, m.id, box_between(m.lowest, m.highest)};
  if (!removes) wish.kind = static_cast<EditKind>(m.action);
  return wish;
}

map_edit_t to_message(const EditWish& wish) {
  map_edit_t message{};
  message.utime = wish.utime_us;
  message.map_id = wish.map_id;
  message.action = wish.kind ? static_cast<std::int32_t>(*wish.kind) : map_edit_t::REMOVE;
  message.id = wish.id;
  if (wish.kind) write(wish.box, message.lowest, message.highest);
  return message;
}

std::optional<EditedBoxes> from_message(const map_edits_t& m) {
  const bool makes_sense = is_sane_utime(m.utime) && m.edits >= 0 && m.moves >= 0;
  if (!makes_sense || !m.refusal.empty() || !are_possible(m.boxes)) return std::nullopt;
  EditedBoxes edited{m.utime, m.map_id, m.edits, m.moves, {}, {}};
  for (const edited_box_t& box : m.boxes) {
    edited.ids.push_back(box.id);
    edited.boxes.push_back(placed(box));
  }
  return edited;
}

map_edits_t to_message(const EditedBoxes& edited) {
  map_edits_t message{};
  message.utime = edited.utime_us;
  message.map_id = edited.map_id;
  message.edits = edited.edits;
  message.moves = edited.moves;
  for (std::size_t i = 0; i < edited.boxes.size(); ++i) {
    const PlacedBox& box = edited.boxes[i];
    edited_box_t& out = message.boxes.emplace_back();
    out.id = edited.ids[i];
    out.kind = static_cast<std::int32_t>(box.kind);
    write(box.box, out.lowest, out.highest);
    const Pose2& moved = box.T_map_box;
    std::ranges::copy(std::array{moved.x_m, moved.y_m, moved.yaw_rad}, out.moved);
  }
  message.n_boxes = static_cast<std::int32_t>(message.boxes.size());
  return message;
}

}  // namespace voxlist::bus
