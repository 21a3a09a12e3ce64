# cmake -D SOURCE=FOLDER -D NUMBER=0.1.0 -D HEADER=FILE -P WriteCommit.cmake: writes the header with the number and the
# commit of the source folder, empty where it is no Git repository of its own. Only when something changed.
cmake_minimum_required(VERSION 3.25)
set(commit "")
execute_process(COMMAND git -C ${SOURCE} rev-parse --show-toplevel
  OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
file(REAL_PATH ${SOURCE} source)
if(top STREQUAL source)
  execute_process(COMMAND git -C ${SOURCE} describe --always --exclude=* --abbrev=8 --dirty=+
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define VOXLIST_NUMBER \"${NUMBER}\"\n#define VOXLIST_COMMIT \"${commit}\"\n")
