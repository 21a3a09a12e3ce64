// `voxlist report`: a page that holds every figure of the paper, and one of one's own run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/voxlist/maps/scan_log.h"
#include "services/voxlist/report/charts/chart.h"
#include "services/voxlist/report/paper/figures.h"
#include "services/voxlist/report/run/surface_distance.h"
#include "tests/desk/scan_set.h"

namespace voxlist::desk {
namespace {

using testing::HasSubstr;
using testing::Not;

// The first complaint about elements that are not closed in the order in which they were opened.
std::string unclosed(const std::string& page) {
  std::vector<std::string> open;
  for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at + 1)) {
    const std::size_t end = page.find('>', at);
    if (end == std::string::npos) return "a tag without an end";
    if (page[at + 1] == '!' || page[end - 1] == '/') continue;
    const bool closes = page[at + 1] == '/';
    const std::size_t first = at + (closes ? 2 : 1);
    const std::string name = page.substr(first, page.find_first_of(" >", first) - first);
    if (!closes) {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return "unexpected </" + name + ">";
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : "no end of <" + open.back() + ">";
}

// The page without what comes from a clock.
std::string untimed(std::string page) {
  const std::string mark = "class=\"timed\">";
  for (std::size_t at = page.find(mark); at != std::string::npos; at = page.find(mark, at + 1))
    page.erase(at + mark.size(), page.find('<', at) - at - mark.size());
  return page;
}

std::string section(const std::string& page, const std::string& id) {
  const auto begin = page.find("<section id=\"" + id + "\">");
  if (begin == std::string::npos) return "";
  return page.substr(begin, page.find("</section>", begin) - begin);
}

class Report : public testing::Test {
 protected:
  std::string page(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"report", "-o", folder_});
    const test::DeskRun run = test::run(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return test::read_text(folder_ + "/index.html");
  }

  test::WorkFolder work_;
  const std::string folder_ = work_ / "report";
};

TEST_F(Report, HoldsEveryFigureWithThePapersValuesBesideOurs) {
  const std::string all = page({"--quick"});
  EXPECT_EQ(unclosed(all), "");
  EXPECT_THAT(all, HasSubstr("quick run of a few scans"));
  for (const PaperFigure& figure : paper_figures()) {
    const std::string text = section(all, figure.id);
    EXPECT_THAT(text, HasSubstr("<blockquote><p>Paper: ")) << figure.id;
    EXPECT_THAT(text, HasSubstr("class=\"paper\">")) << figure.id;
    EXPECT_THAT(text, HasSubstr("class=\"ours\">")) << figure.id;
    EXPECT_THAT(text, HasSubstr("class=\"differs\">")) << figure.id;
    EXPECT_THAT(text, HasSubstr("<dt>seeds</dt>")) << figure.id;
    EXPECT_THAT(text, HasSubstr(std::string("--only ") + figure.id + " --seed 1 --quick"));
  }
  for (const char* id : {"scanner", "fig-4", "algorithm-1", "fig-5", "rate", "fig-6", "section-4",
                         "reliability", "section-5", "fig-7", "fig-8", "resolution"})
    EXPECT_NE(section(all, id), "") << id;
  for (const char* value : {"+-0.02 m", "sub-degree", ">0.02 m<", ">0.07 m<", ">4 mm<", ">6 mm<",
                            ">11 mm<", ">379<", ">0.08 m<", ">10,000 /s<", "0.64 m and coarser",
                            ">2.75 m<", ">up to 5000<", "0.02 m, 0 to 8 m"})
    EXPECT_THAT(all, HasSubstr(value));
}

TEST_F(Report, LoadsNothingFromAnywhere) {
  std::string all = page({"--quick", "--only", "fig-8", "--only", "fig-5"});
  const std::string name_of_svg = "xmlns=\"http://www.w3.org/2000/svg\"";
  for (auto at = all.find(name_of_svg); at != std::string::npos; at = all.find(name_of_svg))
    all.erase(at, name_of_svg.size());
  EXPECT_THAT(all, Not(HasSubstr("://")));
  EXPECT_THAT(all, Not(HasSubstr("src=")));
  EXPECT_THAT(all, Not(HasSubstr("url(")));
  EXPECT_THAT(all, HasSubstr("<svg"));
}

TEST_F(Report, HasTheSameNumbersForTheSameSeed) {
  const std::vector<std::string> some{"--quick", "--only", "fig-6", "--only", "algorithm-1"};
  const std::string first = untimed(page(some));
  EXPECT_TRUE(untimed(page(some)) == first);
  auto other = some;
  other.insert(other.end(), {"--seed", "2"});
  EXPECT_FALSE(untimed(page(other)) == first);
}

TEST_F(Report, SaysWhichFiguresThereAre) {
  const test::DeskRun run = test::run({"report", "-o", folder_, "--only", "fig-9"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("fig-9: no such figure, there are scanner, fig-4"));
}

TEST_F(Report, TellsOfARunAndItsErrors) {
  const std::string scans = work_ / "scans", map = work_ / "map";
  test::make_scan_set(scans);
  ASSERT_EQ(test::run({"map", scans, "-o", map, "--no-octomap"}).exit_code, 0);
  const std::string all = page({"--map", map, "--truth", scans + "/poses.csv"});
  EXPECT_EQ(unclosed(all), "");
  for (const char* id : {"run", "states", "latency", "errors", "surfaces"})
    EXPECT_NE(section(all, id), "") << id;
  EXPECT_THAT(section(all, "states"), HasSubstr("TRACKING"));
  EXPECT_THAT(section(all, "run"), HasSubstr("map_hash"));
  for (const char* distance : {"0.02 m", "0.05 m", "0.10 m"})
    EXPECT_THAT(section(all, "surfaces"), HasSubstr(distance));
}

TEST_F(Report, SaysWhatAMapWithoutScanLogLacks) {
  const std::string scans = work_ / "scans", map = work_ / "map";
  test::make_scan_set(scans);
  ASSERT_EQ(test::run({"map", scans, "-o", map, "--no-octomap"}).exit_code, 0);
  std::filesystem::remove(map + "/scans.csv");
  std::filesystem::remove(map + "/summary.json");
  const std::string all = page({"--map", map});
  EXPECT_THAT(section(all, "states"), HasSubstr("has no scans.csv"));
  EXPECT_THAT(section(all, "run"), HasSubstr("voxlist rebuild"));
}

TEST(ScanLog, ComesBackAsItWasWritten) {
  const test::WorkFolder work;
  const std::string folder = work / "map";
  std::filesystem::create_directories(folder);
  EXPECT_FALSE(read_scan_log(folder));
  write_scan_log(folder, {{0, 1'000'000, matching::LocalisationState::kTracking, 0.999, 12.5},
                          {2, -5, matching::LocalisationState::kLost, 0.0, 0.25}});
  const auto rows = read_scan_log(folder);
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->size(), 2U);
  EXPECT_EQ(rows->back().number, 2);
  EXPECT_EQ(rows->back().utime_us, -5);
  EXPECT_EQ(rows->back().state, matching::LocalisationState::kLost);
  EXPECT_EQ(rows->front().probability, 0.999);
  test::write_text(folder + "/scans.csv",
                   "scan,utime_us,state,probability,elapsed_ms\n1,2,SURE,1,1\n");
  EXPECT_THROW(read_scan_log(folder), std::runtime_error);
}

TEST(Chart, LeavesOutWhatIsNotFiniteAndEscapesNames) {
  const std::string svg = Chart({"a < b & c", {"x"}, {"y", std::nullopt, Scale::kLog}})
                              .line("\"l\"", Ink::kOurs, {{0.0, 1.0}, {NAN, 2.0}, {1.0, 10.0}})
                              .dots("d", Ink::kPaper, {{0.5, -1.0}}, 3.0)
                              .svg();
  EXPECT_EQ(unclosed(svg), "");
  EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; c"));
  EXPECT_THAT(svg, HasSubstr("&quot;l&quot;"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(SurfaceDistance, CountsVoxelsByTheNearestOfTheOtherMap) {
  VoxelMap one, other;
  for (const int x : {0, 1, 2, 100}) one.insert({x, 0, 0});
  for (const int x : {0, 4}) other.insert({x, 0, 0});
  const auto near = shares_near(one, other);  // 0, 1, 2 voxels off, and none within 0.1 m
  EXPECT_DOUBLE_EQ(near[0], 0.5);
  EXPECT_DOUBLE_EQ(near[1], 0.75);
  EXPECT_DOUBLE_EQ(near[2], 0.75);
  EXPECT_EQ(shares_near(VoxelMap(), other)[2], 0.0);
}

}  // namespace
}  // namespace voxlist::desk
