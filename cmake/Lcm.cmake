# Debian's liblcm-dev ships no CMake config, and its .pc file needs glib's: find the three parts ourselves.
find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp REQUIRED)
find_library(LCM_LIBRARY lcm REQUIRED)
find_program(LCM_GEN lcm-gen REQUIRED)

add_library(lcm::lcm UNKNOWN IMPORTED)
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
  target_include_directories(${target} SYSTEM INTERFACE ${CMAKE_CURRENT_BINARY_DIR})
  target_link_libraries(${target} INTERFACE lcm::lcm)
endfunction()
