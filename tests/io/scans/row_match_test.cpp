#include "voxlist/io/scans/row_match.h"

#include <gmock/gmock.h>

#include <string>

namespace voxlist::io {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using Numbers = std::vector<std::int64_t>;

std::vector<std::filesystem::path> files(const Numbers& numbers) {
  std::vector<std::filesystem::path> names;
  for (const auto number : numbers) names.push_back("scan_" + std::to_string(number) + ".ply");
  return names;
}

PoseTable table(const Numbers& numbers, bool has_scans = true) {
  PoseTable table;
  table.has_scans = has_scans;
  for (const auto number : numbers) table.rows.push_back({number, "", 1000 * number});
  return table;
}

// The number in the row of each scan; -1 without a row.
Numbers matched(const RowMatch& match, const PoseTable& table) {
  Numbers numbers;
  for (const auto& row : match.rows) numbers.push_back(row ? table.rows[*row].scan : -1);
  return numbers;
}

Numbers match(const Numbers& scans, const PoseTable& rows) {
  return matched(match_rows(files(scans), {}, rows), rows);
}

Numbers match(const Numbers& scans, const Numbers& rows) { return match(scans, table(rows)); }

TEST(RowMatch, GoesByTheNumbersInNames) {
  EXPECT_THAT(match({0, 1, 2, 4, 5}, {0, 1, 2, 3, 4, 5}), ElementsAre(0, 1, 2, 4, 5));
  EXPECT_THAT(match({0, 1, 2, 3, 4}, {0, 1, 3, 4}), ElementsAre(0, 1, -1, 3, 4));
  EXPECT_THAT(match({0, 1, 2, 4, 5}, {0, 1, 2, 3, 4}), ElementsAre(0, 1, 2, 4, -1));
  EXPECT_THAT(match({0, 2, 4, 6}, {0, 1, 2, 3, 4, 5, 6}), ElementsAre(0, 2, 4, 6));
  EXPECT_THAT(match({100, 101}, {101, 100}), ElementsAre(100, 101));
}

TEST(RowMatch, TakesATableThatCountsOneOffFromTheNames) {
  EXPECT_THAT(match({0, 1, 2, 3}, {1, 2, 3, 4}), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(match({0, 1, 3, 4}, {1, 2, 3, 4, 5}), ElementsAre(1, 2, 4, 5));
  EXPECT_THAT(match({1, 2, 3, 4}, {0, 1, 2, 3}), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(match({0, 1, 2, 3, 4}, {1, 2, 3, 4}), ElementsAre(-1, 1, 2, 3, 4));  // row 0 is gone
  const PoseTable rows = table({1, 2, 3});
  EXPECT_THAT(match_rows(files({0, 1, 2}), {}, rows).notes,
              ElementsAre("the rows count one more than the scans' names"));
}

TEST(RowMatch, GoesByPositionWhereNamesSayNothing) {
  EXPECT_THAT(match({0, 10, 20, 30}, {0, 1, 2, 3}), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(match({100, 110, 120}, {1, 2, 3}), ElementsAre(1, 2, 3));
  const PoseTable rows = table({0, 1});
  EXPECT_THAT(matched(match_rows({"a.ply", "b.ply"}, {}, rows), rows), ElementsAre(0, 1));
}

TEST(RowMatch, OfRowsWithoutNumbersGoesRowByRowIfThereAreAsMany) {
  EXPECT_THAT(match({0, 1, 3}, table({0, 1, 2}, false)), ElementsAre(0, 1, 2));
  EXPECT_THAT(match({0, 1, 3}, table({0, 1, 2, 3}, false)), ElementsAre(0, 1, 3));
  EXPECT_THAT(match({0, 1, 2, 3}, table({0, 1}, false)), ElementsAre(0, 1, -1, -1));
}

TEST(RowMatch, OfRowsWithoutNumbersGoesByTimeWhereItFits) {
  PoseTable rows = table({0, 1, 2}, false);
  rows.has_times = true;
  for (auto& row : rows.rows) row.utime_us = 1'000'000 * row.scan;
  const auto by_time = [&](const Numbers& utimes_us) {
    return matched(match_rows(files({0, 1}), utimes_us, rows), rows);
  };
  EXPECT_THAT(by_time({1'000'004, 2'009'000}), ElementsAre(1, 2));
  EXPECT_THAT(by_time({1'000'004, 3'000'000}), ElementsAre(1, -1));
  EXPECT_THAT(by_time({7'000'000, 8'000'000}), ElementsAre(0, 1));
}

TEST(RowMatch, GoesByFileNamesWhateverTheirExtension) {
  PoseTable rows = table({0, 1, 2});
  rows.has_files = true;
  rows.rows[0].file = "run/scan_2.bin";
  rows.rows[1].file = "scan_1";
  rows.rows[2].file = "scan_7.ply";
  const RowMatch match = match_rows(files({1, 2}), {}, rows);
  EXPECT_THAT(matched(match, rows), ElementsAre(1, 0));
  EXPECT_THAT(match.notes, ElementsAre("row scan_7.ply has no scan"));
}

TEST(RowMatch, TellsWhatHasNoPartner) {
  PoseTable rows = table({0, 1, 2, 3});
  EXPECT_THAT(match_rows(files({0, 1, 2}), {}, rows).notes, ElementsAre("row 3 has no scan"));
  EXPECT_THAT(match_rows(files({0, 3}), {}, rows).notes, ElementsAre("rows 1, 2 have no scan"));
  EXPECT_THAT(match_rows(files({0, 1, 2, 3, 4}), {}, rows).notes,
              ElementsAre("scan_4.ply has no row"));
  EXPECT_THAT(match_rows(files({0, 1, 2, 3}), {}, rows).notes, IsEmpty());
  rows.unknown = 2;
  EXPECT_THAT(match_rows(files({0, 1, 2, 3}), {}, rows).notes,
              Contains("2 rows hold no pose (nan or inf)"));
}

}  // namespace
}  // namespace voxlist::io
