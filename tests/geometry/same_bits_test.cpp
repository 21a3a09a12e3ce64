#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace voxlist {
namespace {

namespace fs = std::filesystem;

// What may use the C library's functions: its results do not reach a map, a pose or a confidence.
struct Exception {
  std::string path, reason;
};
const std::vector<Exception> kExceptions = {
    {"common/geometry/elementary", "the one source itself"},
    {"common/drawing/", "pictures are looked at, not compared"},
    {"common/calibration/", "Ceres' automatic derivatives have the functions of their own numbers"},
    {"common/scanner/sweep/mirror_model.h", "cos and sin of elementary.h, or of Ceres' numbers"},
    {"services/voxlist/report/charts/", "charts are looked at, not compared"},
    {"services/voxlist/report/measured/statistics.cpp", "erfc, in a figure that is printed"},
    {"common/matching/paper/significance.cpp", "erfc, in a bound of the paper that nothing calls"},
};

// The C library's functions that are not exact, and Eigen's that call them. The standard library's
// distributions are other numbers with another library.
const std::regex& forbidden() {
  static const std::string names =
      "(a?sinh?|a?cosh?|a?tanh?|atan2|exp2?|expm1|log2?|log10|log1p|pow|hypot|cbrt|erfc?|[lt]"
      "gamma)";
  static const std::regex pattern("std::" + names + "f?\\b|(^|[^\\w\\s:.>]|return )\\s*" + names +
                                  "f?\\(|\\.array\\(\\)\\." + names +
                                  "\\(|std::fma\\b|AngleAxis|Rotation2D|slerp|eulerAngles|"
                                  "angularDistance|computeDirect|std::\\w+_distribution");
  return pattern;
}

bool is_excepted(const std::string& path) {
  for (const Exception& exception : kExceptions)
    if (path.starts_with(exception.path)) return true;
  return false;
}

std::vector<std::string> forbidden_lines(const fs::path& file, const std::string& name) {
  std::vector<std::string> found;
  std::ifstream in(file);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::string code = line.substr(0, line.find("//"));
    if (std::regex_search(code, forbidden()))
      found.push_back(name + ":" + std::to_string(number) + ": " + line);
  }
  return found;
}

TEST(SameBits, NoResultPassesThroughTheCLibrarysSine) {
  const fs::path top = VOXLIST_SOURCE_DIR;
  std::vector<std::string> found;
  int files = 0;
  for (const char* room : {"common", "services"}) {
    for (const auto& entry : fs::recursive_directory_iterator(top / room)) {
      const std::string name = entry.path().lexically_relative(top).string();
      const std::string extension = entry.path().extension().string();
      if ((extension != ".h" && extension != ".cpp") || is_excepted(name)) continue;
      ++files;
      for (std::string& line : forbidden_lines(entry.path(), name)) found.push_back(line);
    }
  }
  EXPECT_THAT(found, testing::IsEmpty()) << "use voxlist/geometry/elementary.h";
  EXPECT_GT(files, 200);
}

TEST(SameBits, TheTestKnowsTheCLibrarysFunctionsWhenItSeesThem) {
  for (const char* line :
       {"x = std::sin(a);", "using std::cos;", "return exp(x);", "y = 2 * log(x)",
        "T = Eigen::AngleAxisd(a, z)", "q.slerp(t, r)", "sum(std::powf(a, b))", "(pow(x, 2))",
        "v.array().exp()", "std::normal_distribution<> d;"})
    EXPECT_TRUE(std::regex_search(line, forbidden())) << line;
  for (const char* line : {"x = elementary::sin(a);", "EventLogReader log(path);", "mapping(x)",
                           "std::sqrt(x)", "file.log(x)", "std::logic_error(what)"})
    EXPECT_FALSE(std::regex_search(line, forbidden())) << line;
}

}  // namespace
}  // namespace voxlist
