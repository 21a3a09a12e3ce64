# Debian's liblcm-dev ships no CMake config, and its .pc file needs glib's: find the three parts ourselves.
find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp REQUIRED)
find_library(LCM_LIBRARY lcm REQUIRED)
find_program(LCM_GEN lcm-gen REQUIRED)

add_library(lcm::lcm UNKNOWN IMPORTED GLOBAL)
set_target_properties(lcm::lcm PROPERTIES
  IMPORTED_LOCATION ${LCM_LIBRARY}
  INTERFACE_INCLUDE_DIRECTORIES ${LCM_INCLUDE_DIR})

# lcm_types(TARGET FILE...): one header build/lcmtypes/PACKAGE/TYPE_t.hpp for each PACKAGE_TYPE_t.lcm.
function(lcm_types target)
  set(headers "")
  foreach(file IN LISTS ARGN)
    get_filename_component(name ${file} NAME_WE)
    string(REGEX REPLACE "^([a-z]+)_(.*)$" "\\1/\\2.hpp" header ${name})
    add_custom_command(
      OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${header}
      COMMAND ${LCM_GEN} --cpp --cpp-std c++11 --cpp-hpath ${CMAKE_CURRENT_BINARY_DIR} ${file}
      DEPENDS ${file})
    list(APPEND headers ${CMAKE_CURRENT_BINARY_DIR}/${header})
  endforeach()
  add_custom_target(${target}_headers DEPENDS ${headers})
  add_library(${target} INTERFACE)
  add_dependencies(${target} ${target}_headers)
  target_include_directories(${target} SYSTEM INTERFACE
    $<BUILD_INTERFACE:${CMAKE_CURRENT_BINARY_DIR}> $<INSTALL_INTERFACE:include>)
  target_link_libraries(${target} INTERFACE lcm::lcm)
endfunction()

# lcm_python(PACKAGE FILE... ADD MODULE...): the Python package build/lcmtypes/python/PACKAGE of these types and modules.
function(lcm_python package)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" ADD)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/python)
  add_custom_command(
    OUTPUT ${folder}/${package}/__init__.py
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${folder}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}
    COMMAND ${LCM_GEN} --python --ppath ${folder} ${arg_UNPARSED_ARGUMENTS}
    COMMAND ${CMAKE_COMMAND} -E copy ${arg_ADD} ${folder}/${package}
    DEPENDS ${arg_UNPARSED_ARGUMENTS} ${arg_ADD}
    COMMENT "Generating the Python package ${package}")
  add_custom_target(${package}_python ALL DEPENDS ${folder}/${package}/__init__.py)
endfunction()

# lcm_jar(NAME SCRIPT FILE...): build/NAME.jar, made by the script, where there is a Java compiler and LCM's jar.
find_program(JAVAC javac)
find_file(LCM_JAR lcm.jar PATHS /usr/share/java)
function(lcm_jar name script)
  if(NOT JAVAC OR NOT LCM_JAR)
    return()
  endif()
  add_custom_command(
    OUTPUT ${PROJECT_BINARY_DIR}/${name}.jar
    COMMAND ${CMAKE_COMMAND} -E env LCM_JAR=${LCM_JAR} ${script} ${PROJECT_BINARY_DIR}/${name}.jar
    DEPENDS ${script} ${ARGN})
  add_custom_target(${name}_jar ALL DEPENDS ${PROJECT_BINARY_DIR}/${name}.jar)
endfunction()
