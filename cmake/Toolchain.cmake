# How everything of ours is compiled. Third-party headers are system headers and stay out of it.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

# No fused multiply-add, no fast-math: a run must give the same bits on every machine.
add_compile_options(-Wall -Wextra -Wshadow -Wconversion -Wpedantic -Werror -ffp-contract=off)

set(VOXLIST_SANITIZE "" CACHE STRING "sanitizers to build with, e.g. address,undefined or thread")
if(VOXLIST_SANITIZE)
  add_compile_options(-fsanitize=${VOXLIST_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${VOXLIST_SANITIZE})
endif()

find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()
