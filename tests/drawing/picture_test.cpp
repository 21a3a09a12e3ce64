#include "voxlist/drawing/picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/drawing/pixels.h"
#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"

namespace voxlist::drawing {
namespace {

using test::pixels_of;
using test::TemporaryFolder;

constexpr io::Rgb kBlack{0, 0, 0};
constexpr io::Rgb kWhite{255, 255, 255};
constexpr io::Rgb kRed{255, 0, 0};

std::string svg_of(const Picture& picture) {
  const TemporaryFolder folder;
  picture.write_svg(folder / "a.svg");
  return io::read_file(folder / "a.svg");
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(Picture, DrawsDiscsOfTheRightAreaAndLinesWhereTheyBelong) {
  Picture picture(100, 100, kBlack);
  picture.disc({50.0, 50.0}, 40.0, kWhite);
  EXPECT_NEAR(static_cast<double>(pixels_of(picture).count(kWhite)), 3.14159 * 19.5 * 19.5, 60.0);
  picture.line({{0.0, 10.0}, {99.0, 10.0}}, 1.0, kRed);
  EXPECT_EQ(pixels_of(picture).at(1, 10), kRed);
  EXPECT_EQ(pixels_of(picture).at(98, 10), kRed);
  EXPECT_EQ(pixels_of(picture).at(50, 12), kBlack);
}

TEST(Picture, BreaksALineWhereAPointIsNone) {
  Picture picture(100, 20, kBlack);
  picture.line({{0.0, 10.0}, {20.0, 10.0}, {NAN, 10.0}, {60.0, 10.0}, {99.0, 10.0}}, 1.0, kRed);
  EXPECT_EQ(pixels_of(picture).at(10, 10), kRed);
  EXPECT_EQ(pixels_of(picture).at(40, 10), kBlack);
  EXPECT_EQ(pixels_of(picture).at(80, 10), kRed);
}

TEST(Picture, LeavesOutWhatLiesOutside) {
  Picture picture(10, 10, kBlack);
  picture.disc({1e12, -1e12}, 5.0, kRed);
  picture.line({{-50.0, 5.0}, {HUGE_VAL, 5.0}}, 1.0, kRed);
  picture.line({{-50.0, -5.0}, {50.0, -5.0}}, 1.0, kRed);
  picture.text({500.0, 500.0}, "far", 20.0, kRed);
  picture.paste(Raster(5, 5, kRed), 10, -5);
  EXPECT_EQ(pixels_of(picture).count(kBlack), 100U);
  picture.line({{-50.0, 5.0}, {50.0, 5.0}}, 1.0, kRed);
  EXPECT_EQ(pixels_of(picture).count(kRed), 10U);
  EXPECT_THROW(Picture(0, 10, kBlack), std::invalid_argument);
}

TEST(Picture, WritesTextAsWideAsItSaysAndWhereItIsTold) {
  Picture picture(200, 40, kBlack);
  const double width = picture.text({100.0, 30.0}, "10 m", 20.0, kWhite, TextAnchor::kCentre);
  const test::Pixels pixels = pixels_of(picture);
  int left = 200, right = 0, top = 40, bottom = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 200; ++x) {
      if (pixels.at(x, y) == kBlack) continue;
      left = std::min(left, x), right = std::max(right, x);
      top = std::min(top, y), bottom = std::max(bottom, y);
    }
  }
  EXPECT_NEAR(left + right, 200, 8);
  EXPECT_NEAR(right - left, width, 8.0);
  EXPECT_NEAR(bottom, 30, 1);
  EXPECT_NEAR(bottom - top, 0.73 * 20.0, 2.0);
}

TEST(Picture, LettersDiffer) {
  const auto written = [](const std::string& words) {
    Picture picture(60, 40, kBlack);
    picture.text({10.0, 30.0}, words, 20.0, kWhite);
    return pixels_of(picture).rgb;
  };
  EXPECT_NE(written("a"), written("A"));
  EXPECT_NE(written("6"), written("9"));
}

TEST(Picture, PastesImagesAndPicturesAtWholePixels) {
  Picture picture(30, 20, kBlack);
  Raster raster(4, 3, kWhite);
  raster.fill(-5, 2, 2, 9, kRed);
  picture.paste(raster, 10, 5);
  EXPECT_EQ(pixels_of(picture).count(kWhite), 10U);
  EXPECT_EQ(pixels_of(picture).count(kRed), 2U);
  EXPECT_EQ(pixels_of(picture).at(10, 7), kRed);
  Picture page(60, 20, kRed);
  page.paste(picture, 30, 0);
  EXPECT_EQ(pixels_of(page).at(40, 5), kWhite);
  EXPECT_EQ(pixels_of(page).count(kBlack), 30U * 20U - 12U);
}

TEST(Picture, AsSvgIsXmlWithAGlyphForEachLetter) {
  Picture picture(300, 60, kWhite);
  const std::size_t before = count(svg_of(picture), "<use ");
  picture.text({10.0, 30.0}, "y (m) <&", 20.0, kBlack);
  picture.line({{0.0, 50.0}, {299.0, 50.0}}, 2.0, kRed);
  const std::string svg = svg_of(picture);
  EXPECT_TRUE(test::is_xml(svg)) << svg;
  EXPECT_NE(svg.find("<svg"), std::string::npos);
  EXPECT_NE(svg.find("width=\"300px\""), std::string::npos) << svg.substr(0, 300);
  EXPECT_GE(count(svg, "<use ") - before, 6U) << svg;  // blanks may be left out
  EXPECT_NE(svg.find("rgb(100%,0%,0%)"), std::string::npos) << svg;
}

TEST(Picture, SaysWhereItCannotBeWrittenAndLeavesWhatWasThere) {
  const TemporaryFolder folder;
  const Picture picture(10, 10, kBlack);
  EXPECT_THROW(picture.write_png(folder / "none/a.png"), io::FileError);
  EXPECT_THROW(picture.write_svg(folder / "none/a.svg"), io::FileError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Colour, RunsThroughViridis) {
  EXPECT_EQ(io::viridis(0.0), (io::Rgb{68, 1, 84}));
  EXPECT_EQ(io::viridis(0.5), (io::Rgb{33, 144, 141}));
  EXPECT_EQ(io::viridis(7.0), (io::Rgb{253, 231, 37}));
  EXPECT_EQ(io::mix(kBlack, kWhite, 0.5), (io::Rgb{128, 128, 128}));
}

}  // namespace
}  // namespace voxlist::drawing
