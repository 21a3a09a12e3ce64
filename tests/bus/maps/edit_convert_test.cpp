#include "voxlist/bus/maps/edit_convert.h"

#include <gtest/gtest.h>

#include <limits>
#include <voxlist/map_edit_t.hpp>
#include <voxlist/map_edits_t.hpp>

#include "voxlist/voxels/edits/edit_limits.h"

namespace voxlist::bus {
namespace {

const Eigen::AlignedBox3d kBox(Eigen::Vector3d(-1.0, 0.5, 1e-9), Eigen::Vector3d(2.0, 3.5, 1.0));

EditedBoxes some_boxes() {
  return {5, 42,     9,
          3, {4, 8}, {{EditKind::kErase, kBox}, {EditKind::kKeepBlocked, kBox, {1.0, -2.0, 0.5}}}};
}

TEST(EditMessages, CarryAWishAsItIs) {
  for (const auto kind : {EditKind::kErase, EditKind::kKeepFree, EditKind::kKeepBlocked}) {
    const auto wish = from_message(to_message(EditWish{7, 42, kind, 0, kBox}));
    ASSERT_TRUE(wish);
    EXPECT_EQ(wish->utime_us, 7);
    EXPECT_EQ(wish->map_id, 42);
    EXPECT_EQ(wish->kind, kind);
    EXPECT_EQ(wish->box.min(), kBox.min());
    EXPECT_EQ(wish->box.max(), kBox.max());
  }
  const auto removed = from_message(to_message(EditWish{7, 42, std::nullopt, 13, {}}));
  ASSERT_TRUE(removed);
  EXPECT_FALSE(removed->kind);
  EXPECT_EQ(removed->id, 13);
}

TEST(EditMessages, AreNoWishWithoutATimeOrAnActionThatIsKnown) {
  map_edit_t message = to_message(EditWish{7, 42, EditKind::kErase, 0, kBox});
  message.utime = -1;
  EXPECT_FALSE(from_message(message));
  message.utime = 7;
  for (const std::int32_t action : {-1, 4, std::numeric_limits<std::int32_t>::max()}) {
    message.action = action;
    EXPECT_FALSE(from_message(message));
  }
}

TEST(EditMessages, CarryBoxesAsTheyAre) {
  const auto boxes = from_message(to_message(some_boxes()));
  ASSERT_TRUE(boxes);
  EXPECT_EQ(boxes->utime_us, 5);
  EXPECT_EQ(boxes->map_id, 42);
  EXPECT_EQ(boxes->edits, 9);
  EXPECT_EQ(boxes->moves, 3);
  EXPECT_EQ(boxes->ids, some_boxes().ids);
  ASSERT_EQ(boxes->boxes.size(), 2U);
  EXPECT_EQ(boxes->boxes[1].kind, EditKind::kKeepBlocked);
  EXPECT_EQ(boxes->boxes[1].T_map_box, (Pose2{1.0, -2.0, 0.5}));
  EXPECT_EQ(boxes->boxes[1].box.min(), kBox.min());
}

TEST(EditMessages, AreRefusedWhereNoMapHasSuchBoxes) {
  const auto refused = [](auto spoil) {
    map_edits_t message = to_message(some_boxes());
    spoil(message);
    return !from_message(message);
  };
  EXPECT_TRUE(refused([](map_edits_t& m) { m.refusal = "no"; }));
  EXPECT_TRUE(refused([](map_edits_t& m) { m.utime = -1; }));
  EXPECT_TRUE(refused([](map_edits_t& m) { m.edits = -1; }));
  EXPECT_TRUE(refused([](map_edits_t& m) { m.boxes[0].kind = 3; }));
  EXPECT_TRUE(refused([](map_edits_t& m) { m.boxes[0].highest[1] = 1e7; }));
  EXPECT_TRUE(refused(
      [](map_edits_t& m) { m.boxes[1].moved[2] = std::numeric_limits<double>::infinity(); }));
  EXPECT_TRUE(refused([](map_edits_t& m) { m.boxes.resize(kMostEdits + 1, m.boxes[0]); }));
  EXPECT_FALSE(refused([](map_edits_t&) {}));
}

}  // namespace
}  // namespace voxlist::bus
