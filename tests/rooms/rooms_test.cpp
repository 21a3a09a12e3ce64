// The rooms of the tree: common/README.md lists those of common lowest first, and here every
// #include is held against that list. The desk tool's rooms and the services are in the test.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace voxlist {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = VOXLIST_SOURCE_DIR;
constexpr int kMostFilesInAFolder = 25;

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> all_matches(const std::string& text, const std::regex& what) {
  std::vector<std::string> found;
  for (std::sregex_iterator i(text.begin(), text.end(), what), end; i != end; ++i)
    found.push_back((*i)[1]);
  return found;
}

bool is_source(const fs::path& path) {
  return path.extension() == ".h" || path.extension() == ".cpp";
}

std::vector<fs::path> sources_below(const fs::path& folder) {
  std::vector<fs::path> sources;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && is_source(entry.path())) sources.push_back(entry.path());
  return sources;
}

// Height of each room: its line in the table. Rooms on one line have the same.
using Heights = std::map<std::string, int>;

Heights heights_of_common() {
  Heights heights;
  int line_number = 0;
  std::ifstream in(kRoot / "common" / "README.md");
  for (std::string line; std::getline(in, line); ++line_number) {
    if (!line.starts_with("| `")) continue;
    const std::string rooms = line.substr(0, line.find('|', 1));
    for (const std::string& room : all_matches(rooms, std::regex("`([a-z0-9_/]+)`")))
      heights[room] = line_number;
  }
  return heights;
}

// Complaints about includes that do not go down. `prefix`: what an include of these rooms begins
// with. Includes of what is in no room of the list are somebody else's.
std::vector<std::string> wrong_arrows(const fs::path& folder, const std::string& prefix,
                                      const Heights& heights) {
  std::vector<std::string> wrong;
  for (const fs::path& source : sources_below(folder)) {
    const std::string room = fs::relative(source.parent_path(), folder);
    const auto own = heights.find(room);
    if (own == heights.end()) {
      wrong.push_back(source.string() + " is in a room that is not listed");
      continue;
    }
    const std::regex include("#include \"" + prefix + "([a-z0-9_/]+)/[a-z0-9_]+\\.h\"");
    for (const std::string& target : all_matches(text_of(source), include)) {
      const auto other = heights.find(target);
      if (target != room && other != heights.end() && other->second >= own->second)
        wrong.push_back(source.string() + " includes " + target);
    }
  }
  return wrong;
}

TEST(Rooms, IncludeOnlyWhatStandsAboveThemInTheList) {
  const Heights heights = heights_of_common();
  ASSERT_GT(heights.size(), 25U);
  for (const std::string& complaint : wrong_arrows(kRoot / "common", "voxlist/", heights))
    ADD_FAILURE() << complaint;
}

TEST(Rooms, AreAllListedAndAllThere) {
  std::set<std::string> there, listed;
  for (const fs::path& source : sources_below(kRoot / "common"))
    there.insert(fs::relative(source.parent_path(), kRoot / "common"));
  for (const auto& [room, height] : heights_of_common()) listed.insert(room);
  EXPECT_EQ(listed, there);
}

TEST(Rooms, InTheDeskToolIncludeOnlyDownwards) {
  const Heights heights{{"output", 0},
                        {"report/charts", 0},
                        {"recording", 1},
                        {"live", 1},
                        {"view", 1},
                        {"maps/ahead", 1},
                        {"maps/sessions", 1},
                        {"report/page", 1},
                        {"report/measured", 1},
                        {"maps", 2},
                        {"report/paper", 2},
                        {"report/run", 3},
                        {"commands", 4},
                        {"commands/edits", 5},
                        {"commands/robot", 5},
                        {"commands/views", 5},
                        {".", 6}};
  for (const std::string& complaint :
       wrong_arrows(kRoot / "services" / "voxlist", "services/voxlist/", heights))
    ADD_FAILURE() << complaint;
}

TEST(Rooms, KnowNoServiceAndServicesKnowNoOther) {
  const std::regex service("#include \"services/([a-z0-9_]+)/");
  for (const fs::path& source : sources_below(kRoot / "common"))
    EXPECT_TRUE(all_matches(text_of(source), service).empty()) << source;
  const std::vector<fs::path> sources = sources_below(kRoot / "services");
  ASSERT_FALSE(sources.empty());
  for (const fs::path& source : sources) {
    const std::string own = *fs::relative(source, kRoot / "services").begin();
    for (const std::string& other : all_matches(text_of(source), service))
      EXPECT_EQ(other, own) << source;
  }
}

TEST(Rooms, OnlyTheBusIncludesLcm) {
  const std::regex lcm("#include [<\"](lcm)/");
  int users = 0;
  for (const char* tree : {"common", "services"}) {
    for (const fs::path& source : sources_below(kRoot / tree)) {
      if (all_matches(text_of(source), lcm).empty()) continue;
      ++users;
      EXPECT_EQ(source.parent_path(), kRoot / "common" / "bus") << source;
    }
  }
  EXPECT_GT(users, 0);
}

TEST(Rooms, HoldAtMostTwentyFiveFiles) {
  for (const char* tree : {"common", "services", "tests", "lcmtypes", "scripts", "cmake"}) {
    std::map<fs::path, int> files;
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / tree))
      if (entry.is_regular_file()) ++files[entry.path().parent_path()];
    EXPECT_FALSE(files.empty()) << tree;
    for (const auto& [folder, count] : files) EXPECT_LE(count, kMostFilesInAFolder) << folder;
  }
}

TEST(Rooms, EachSayWhatTheyAreFor) {
  for (const auto& [room, height] : heights_of_common()) {
    const std::string readme = text_of(kRoot / "common" / room / "README.md");
    EXPECT_FALSE(readme.empty()) << room;
    EXPECT_NE(readme.find(".h"), std::string::npos) << room << " names no header to start with";
  }
}

}  // namespace
}  // namespace voxlist
