# cmake -D FOLDER=lcmtypes -D SOURCE=FILE.cpp -P EmbedLcmTypes.cmake: writes foreign/lcm/lcm_types.h's table of all types.
set(includes "")
set(entries "")
file(GLOB_RECURSE paths ${FOLDER}/*.lcm)
foreach(path IN LISTS paths)
  cmake_path(GET path STEM name)
  string(REGEX REPLACE "^([a-z]+)_(.*)$" "\\1;\\2" names ${name})
  list(GET names 0 package)
  list(GET names 1 type)
  file(READ ${path} text)
  string(APPEND includes "#include <${package}/${type}.hpp>\n")
  string(APPEND entries
    "    {${package}::${type}::getHash(), \"${package}.${type}\", R\"~~~(${text})~~~\"},\n")
endforeach()
file(WRITE ${SOURCE} "${includes}
#include \"voxlist/foreign/lcm/lcm_types.h\"

namespace voxlist::foreign {

std::span<const LcmType> lcm_types() {
  static const LcmType kTypes[] = {
${entries}};
  return kTypes;
}

}  // namespace voxlist::foreign
")
