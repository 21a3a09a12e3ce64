#include "voxlist/planning/grids/grid_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "tests/temporary_folder.h"

namespace voxlist::planning {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Two rows: unknown, free, obstacle below overhang, negative, free.
TypedGrid small_grid() {
  return {{{-8, 16}, {-5, 18}},
          {CellType::kUnknown, CellType::kFree, CellType::kObstacle, CellType::kOverhang,
           CellType::kNegative, CellType::kFree}};
}

// What map_server makes of a map: 100 occupied, 0 free, -1 unknown, from the lowest row on; and
// where its lower left corner is.
struct ServedMap {
  int width = 0, height = 0;
  double resolution_m = 0.0, x_m = 0.0, y_m = 0.0;
  std::vector<int> cells;
};

std::map<std::string, std::string> yaml_keys(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::map<std::string, std::string> keys;
  for (std::string line; std::getline(in, line);)
    keys[line.substr(0, line.find(':'))] = line.substr(line.find(':') + 2);
  return keys;
}

int served(unsigned char grey, double occupied_thresh, double free_thresh) {
  const double occupied = 1.0 - grey / 255.0;
  return occupied > occupied_thresh ? 100 : occupied < free_thresh ? 0 : -1;
}

// Strict comparisons, as map_server has them; the image's name is relative to the YAML.
ServedMap serve(const std::filesystem::path& file, std::optional<double> free_thresh = {}) {
  auto keys = yaml_keys(file);
  EXPECT_EQ(keys["negate"], "0");
  EXPECT_EQ(keys["mode"], "trinary");
  ServedMap map;
  map.resolution_m = std::stod(keys["resolution"]);
  EXPECT_EQ(std::sscanf(keys["origin"].c_str(), "[%lf, %lf, 0.0]", &map.x_m, &map.y_m), 2);
  std::ifstream image(file.parent_path() / keys["image"], std::ios::binary);
  std::string magic;
  int most = 0;
  image >> magic >> map.width >> map.height >> most;
  image.get();
  EXPECT_EQ(magic, "P5");
  EXPECT_EQ(most, 255);
  std::string pixels(static_cast<std::size_t>(map.width * map.height), '\0');
  image.read(pixels.data(), static_cast<std::streamsize>(pixels.size()));
  EXPECT_TRUE(image);
  const double limit = free_thresh.value_or(std::stod(keys["free_thresh"]));
  for (int y = map.height; y-- > 0;)
    for (int x = 0; x < map.width; ++x)
      map.cells.push_back(
          served(static_cast<unsigned char>(pixels[static_cast<std::size_t>(y * map.width + x)]),
                 std::stod(keys["occupied_thresh"]), limit));
  return map;
}

TEST(GridFiles, ReadInMapServerAsTheGridUnderItsOldLimitAndItsNewOne) {
  const test::TemporaryFolder folder;
  write_grid(small_grid(), folder.path(), "low");
  for (const auto& limit : {std::optional<double>(), std::optional(0.196), std::optional(0.25)}) {
    const ServedMap map = serve(folder / "low.yaml", limit);
    EXPECT_EQ(map.width, 3);
    EXPECT_EQ(map.height, 2);
    EXPECT_NEAR(map.resolution_m, 0.08, 1e-9);
    EXPECT_NEAR(map.x_m, -0.64, 1e-9);
    EXPECT_NEAR(map.y_m, 1.28, 1e-9);
    EXPECT_THAT(map.cells, ElementsAre(-1, 0, 100, 100, 100, 0));
  }
}

TEST(GridFiles, TellResolutionByNineDigits) {
  EXPECT_THAT(yaml(small_grid().box, "low.pgm"), HasSubstr("resolution: 0.080000000\n"));
}

TEST(GridFiles, HavePicturesInWhichTypesDiffer) {
  const drawing::Raster raster = typed_raster(small_grid());
  ASSERT_EQ(raster.pixels.size(), 6u);
  // The upper row comes first: overhang, negative, free; then unknown, free, obstacle.
  EXPECT_EQ(raster.pixels[2], raster.pixels[4]);
  for (const std::size_t a : {0u, 1u, 2u, 3u, 5u})
    for (const std::size_t b : {0u, 1u, 2u, 3u, 5u})
      EXPECT_EQ(raster.pixels[a] == raster.pixels[b], a == b) << a << ' ' << b;
}

TEST(GridFiles, HaveLikelihoodsThatNameUnknownByTheMiddle) {
  EXPECT_THAT(likelihoods(small_grid()), ElementsAre(127, 0, 255, 255, 255, 0));
}

TEST(GridFiles, AreCutIntoTilesThatCoverTheGrid) {
  const CellBox box{{-8, 0}, {16, 8}};
  EXPECT_EQ(tiles_of(box).size(), 1u);
  EXPECT_EQ(tiles_of(box).front().suffix, "");
  const auto tiles = tiles_of(box, 10);
  ASSERT_EQ(tiles.size(), 3u);
  std::size_t cells = 0;
  for (const GridTile& tile : tiles) cells += tile.box.size();
  EXPECT_EQ(cells, box.size());
  EXPECT_EQ(tiles[2].suffix, "_2_0");
  EXPECT_EQ(tiles[2].box.low.x, 12);
}

TEST(GridFiles, HaveInATileWhatTheGridHasThere) {
  const TypedGrid part = part_of(small_grid(), {{-7, 17}, {-5, 18}});
  EXPECT_THAT(part.cells, ElementsAre(CellType::kNegative, CellType::kFree));
}

TEST(GridFiles, RefuseAGridThatIsTooLargeForOneImage) {
  const test::TemporaryFolder folder;
  TypedGrid grid{{{0, 0}, {kLargestImage + 1, 1}}, {}};
  grid.cells.resize(grid.box.size());
  EXPECT_THROW(write_grid(grid, folder.path(), "low"), std::length_error);
}

}  // namespace
}  // namespace voxlist::planning
