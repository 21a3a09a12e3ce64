#include "tests/scanner/lms200/carmen_log.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>

namespace voxlist::scanner {

std::vector<std::vector<float>> carmen_scans() {
  const char* folder = std::getenv("VOXLIST_DATA");
  const std::filesystem::path data =
      folder != nullptr ? folder : VOXLIST_SOURCE_DIR "/../shared/data";
  const auto file = data / "carmen" / "fr079.clf.bz2";
  std::vector<std::vector<float>> scans;
  if (!std::filesystem::exists(file)) return scans;
  const std::string command = "bzcat '" + file.string() + "'";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  char* text = nullptr;
  std::size_t room = 0;
  while (pipe && getline(&text, &room, pipe.get()) > 0) {
    std::istringstream in(text);
    std::string word;
    std::size_t beams = 0;
    if (!(in >> word >> beams) || word != "FLASER" || beams != 360) continue;
    std::vector<float>& scan = scans.emplace_back(beams);
    for (float& range_m : scan) in >> range_m;
  }
  std::free(text);
  return scans;
}

}  // namespace voxlist::scanner
