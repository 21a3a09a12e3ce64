# How everything of ours is compiled. All of it holds for this folder and what is below: a project that adds this one
# with add_subdirectory keeps its own flags. Third-party headers are system headers and stay out of it.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

# No fused multiply-add, no fast-math: a run must give the same bits on every machine.
add_compile_options(-ffp-contract=off)

# A newer compiler's new warning must not stop somebody who only uses the library.
option(VOXLIST_WARNINGS "warnings, as errors" ${PROJECT_IS_TOP_LEVEL})
if(VOXLIST_WARNINGS)
  add_compile_options(-Wall -Wextra -Wshadow -Wconversion -Wpedantic -Werror)
endif()

set(VOXLIST_SANITIZE "" CACHE STRING "sanitizers to build with, e.g. address,undefined or thread")
if(VOXLIST_SANITIZE)
  add_compile_options(-fsanitize=${VOXLIST_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${VOXLIST_SANITIZE})
  # GCC 12 takes std::regex for uninitialised once it is instrumented.
  add_compile_options(-Wno-maybe-uninitialized)
endif()

find_program(VOXLIST_CCACHE ccache)
if(VOXLIST_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${VOXLIST_CCACHE})
endif()
