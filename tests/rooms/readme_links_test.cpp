// Links in the READMEs lead to files that are there, and no formatter of code went over their
// titles.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

namespace voxlist {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = VOXLIST_SOURCE_DIR;

std::vector<fs::path> readmes() {
  std::vector<fs::path> found{kRoot / "README.md"};
  for (const char* tree : {"common", "services", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / tree))
      if (entry.path().filename() == "README.md") found.push_back(entry.path());
  return found;
}

// Targets of [text](target) without what follows a #; web addresses are left out.
std::vector<std::string> links_of(const fs::path& readme) {
  std::ifstream in(readme);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::regex link(R"(\]\(([^)#:]+)[^):]*\))");
  std::vector<std::string> links;
  for (std::sregex_iterator i(text.begin(), text.end(), link), end; i != end; ++i)
    links.push_back((*i)[1]);
  return links;
}

TEST(Readmes, LinkToFilesThatAreThere) {
  int links = 0;
  for (const fs::path& readme : readmes()) {
    for (const std::string& link : links_of(readme)) {
      EXPECT_TRUE(fs::exists(readme.parent_path() / link)) << readme << " links to " << link;
      ++links;
    }
  }
  EXPECT_GT(links, 100);
}

TEST(Readmes, BeginWithATitle) {
  for (const fs::path& readme : readmes()) {
    std::ifstream in(readme);
    std::string title;
    std::getline(in, title);
    EXPECT_TRUE(title.starts_with("# ")) << readme << ": " << title;
  }
}

}  // namespace
}  // namespace voxlist
