// Writes what a map folder's keyframes make: "map ID, N keyframes, hash HASH", as `voxlist map`
// puts the hash. Usage: map_hash FOLDER
#include <cstdio>
#include <exception>

#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"

int main(int argc, char** argv) try {
  if (argc != 2) return 2;
  using namespace voxlist::mapping;
  KeyframeReader reader(std::filesystem::path(argv[1]) / kKeyframeFile);
  MapBuilder builder;
  while (auto keyframe = reader.next()) builder.add(std::move(*keyframe));
  std::printf("map %lld, %zu keyframes, hash %016llx\n",
              static_cast<long long>(reader.map_id().value_or(0)), builder.poses().size(),
              static_cast<unsigned long long>(builder.map().occupied.hash()));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "map_hash: %s\n", error.what());
  return 1;
}
