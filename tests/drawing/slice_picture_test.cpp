#include "voxlist/drawing/slice_picture.h"

#include <gtest/gtest.h>

#include "tests/drawing/pixels.h"
#include "voxlist/drawing/map_marks.h"

namespace voxlist::drawing {
namespace {

constexpr io::Rgb kOccupied{250, 214, 92};

// A wall of 10 m along y = 0 with 2 m of free space before it.
MapSlice wall() {
  MapSlice slice;
  slice.view.resolution_m = slice.view.free_m = 0.1;
  for (int x = 0; x < 100; ++x) {
    const float along = 0.1F * (static_cast<float>(x) + 0.5F);
    slice.view.occupied.emplace_back(along, 0.05F, 1.0F);
    slice.view.occupied.emplace_back(along, 4.05F, 1.0F);
    for (int y = 1; y < 20; ++y)
      slice.view.free.emplace_back(along, 0.1F * (static_cast<float>(y) + 0.5F));
  }
  return slice;
}

TEST(SlicePicture, TellsOccupiedFreeAndUnknown) {
  const test::Pixels pixels = test::pixels_of(draw_slices({wall()}));
  const auto cells = [](double count) { return count * 142.0 * 142.0 / 100.0; };  // pixels
  EXPECT_NEAR(static_cast<double>(pixels.count(kOccupied)), cells(200.0), cells(20.0));
  EXPECT_NEAR(static_cast<double>(pixels.count(kFree)), cells(1900.0), cells(100.0));
  EXPECT_EQ(pixels.at(770, 150), kUnknown) << "beyond what was seen";
}

TEST(SlicePicture, ShowsWhatIsKeptBlockedAsOccupied) {
  MapSlice slice = wall();
  const std::size_t before = test::pixels_of(draw_slices({slice})).count(kOccupied);
  slice.blocked = {{2.05F, 3.05F}, {2.15F, 3.05F}};
  const std::size_t blocked = test::pixels_of(draw_slices({slice})).count(kOccupied) - before;
  EXPECT_NEAR(static_cast<double>(blocked), 2.0 * 14.2 * 14.2, 60.0);
}

TEST(SlicePicture, DrawsTwoOfOnePlaceSideBySide) {
  MapSlice gone = wall();
  gone.view.occupied.clear();
  const Picture two = draw_slices({gone, wall()});
  EXPECT_EQ(two.width(), 1540);
  const test::Pixels pixels = test::pixels_of(two);
  const auto count = [&](int from, int to) {
    int n = 0;
    for (int x = from; x < to; ++x)
      for (int y = 36; y < two.height() - kFooter; ++y) n += pixels.at(x, y) == kOccupied;
    return n;
  };
  EXPECT_EQ(count(0, 770), 0);
  EXPECT_GT(count(770, 1540), 1000);
}

TEST(SlicePicture, DrawsEvenAnEmptyMap) { EXPECT_EQ(draw_slices({{}}).width(), 1540); }

}  // namespace
}  // namespace voxlist::drawing
