# The three kinds of targets. Each takes every .cpp of its folder, so adding a file is adding a file.

# The tree below common/ is what others include as voxlist/...; in the build folder a link gives it that name.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/common ${PROJECT_BINARY_DIR}/include/voxlist SYMBOLIC)

# voxlist_library(NAME DEPENDS... [PRIVATE DEPENDS...]): target voxlist_NAME, alias voxlist::NAME, from common/NAME and
# its sub-folders; installed with its headers. Left out, with what needs it, where one of DEPENDS is not there.
function(voxlist_library name)
  set(needs ${ARGN})
  list(REMOVE_ITEM needs PRIVATE)
  foreach(need IN LISTS needs)
    if(NOT TARGET ${need})
      message(STATUS "voxlist::${name} is left out: ${need} is not there")
      return()
    endif()
  endforeach()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  set(kind STATIC)
  set(scope PUBLIC)
  if(NOT sources) # headers alone
    set(kind INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(voxlist_${name} ${kind} ${sources})
  add_library(voxlist::${name} ALIAS voxlist_${name})
  target_compile_features(voxlist_${name} ${scope} cxx_std_20)
  target_include_directories(voxlist_${name} ${scope} $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>)
  target_link_libraries(voxlist_${name} ${scope} ${ARGN})
  voxlist_install_library(${name} ${needs})
endfunction()

# voxlist_program(NAME DEPENDS...): build/bin/NAME from services/NAME. Everything but main.cpp also
# becomes the library voxlist_service_NAME, so that tests run a service in their own process.
function(voxlist_program name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
  set(library voxlist_service_${name})
  if(sources)
    add_library(${library} STATIC ${sources})
    target_include_directories(${library} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(${library} PUBLIC ${ARGN})
  else()
    add_library(${library} INTERFACE)
    target_link_libraries(${library} INTERFACE ${ARGN})
  endif()
  add_executable(${name}_program ${CMAKE_CURRENT_SOURCE_DIR}/${name}/main.cpp)
  set_target_properties(${name}_program PROPERTIES OUTPUT_NAME ${name})
  target_link_libraries(${name}_program PRIVATE ${library})
  voxlist_install_program(${name})
endfunction()

# voxlist_say_where(FILE...): tells those of the files that ask for it where the source and the programs are. Only those:
# what is compiled the same for two build folders comes from ccache.
function(voxlist_say_where)
  foreach(file IN LISTS ARGN)
    file(STRINGS ${file} asks REGEX "VOXLIST_(SOURCE|BIN)_DIR" LIMIT_COUNT 1)
    if(asks)
      set_property(SOURCE ${file} APPEND PROPERTY COMPILE_DEFINITIONS
        VOXLIST_SOURCE_DIR="${PROJECT_SOURCE_DIR}" VOXLIST_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
    endif()
  endforeach()
endfunction()

# voxlist_test(FOLDER DEPENDS...): program test_FOLDER from tests/FOLDER, each TEST its own ctest case.
function(voxlist_test folder)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(test_${folder} ${sources})
  target_link_libraries(test_${folder} PRIVATE ${ARGN} GTest::gmock GTest::gtest_main)
  target_include_directories(test_${folder} PRIVATE ${PROJECT_SOURCE_DIR})
  voxlist_say_where(${sources})
  gtest_discover_tests(test_${folder} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT ${VOXLIST_TIMEOUT})
endfunction()
