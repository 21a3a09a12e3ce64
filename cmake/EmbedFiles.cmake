# cmake -D FOLDER=FOLDER -D SOURCE=FILE.cpp -P EmbedFiles.cmake: writes viewing/server/page_files.h's table of all files
# of the folder. So the page is where the program is, however that was installed.
set(types ".html text/html" ".css text/css" ".js text/javascript" ".svg image/svg+xml")
set(entries "")
file(GLOB paths ${FOLDER}/*.html ${FOLDER}/*.css ${FOLDER}/*.js ${FOLDER}/*.svg)
foreach(path IN LISTS paths)
  cmake_path(GET path FILENAME name)
  cmake_path(GET path EXTENSION LAST_ONLY extension)
  string(REGEX MATCH "\\${extension} ([a-z/+]+)" type "${types}")
  set(type ${CMAKE_MATCH_1})
  set(target "/${name}")
  if(name STREQUAL index.html)
    set(target "/")
  endif()
  file(READ ${path} text)
  string(APPEND entries "    {\"${target}\", \"${type}; charset=utf-8\", R\"~~~(${text})~~~\"},\n")
endforeach()
file(WRITE ${SOURCE} "#include \"voxlist/viewing/server/page_files.h\"

namespace voxlist::viewing {
namespace {

constexpr PageFile kFiles[] = {
${entries}};

}  // namespace

std::span<const PageFile> page_files() { return kFiles; }

}  // namespace voxlist::viewing
")
