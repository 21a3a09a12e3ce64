// Writes the time of each keyframe in a map folder (us, one a line, in the order of the file) and,
// on stderr, what of the file is damaged. Usage: map_times FOLDER
#include <cstdio>
#include <exception>
#include <filesystem>

#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"

int main(int argc, char** argv) try {
  if (argc != 2) return 2;
  using namespace voxlist::mapping;
  KeyframeReader reader(std::filesystem::path(argv[1]) / kKeyframeFile);
  while (const auto keyframe = reader.next())
    std::printf("%lld\n", static_cast<long long>(keyframe->cloud.utime_us));
  if (!reader.warning().empty()) std::fprintf(stderr, "%s\n", reader.warning().c_str());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "map_times: %s\n", error.what());
  return 1;
}
