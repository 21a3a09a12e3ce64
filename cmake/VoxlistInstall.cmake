# What `cmake --install` lays down: component "development" is the library (headers, static libraries, CMake files),
# component "programs" the services and the desk tool. Consumers link voxlist::ROOM after find_package(voxlist).
include(CMakePackageConfigHelpers)
set(voxlist_cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/voxlist)

# voxlist_install_library(ROOM NEEDS...): a room of common/ with its headers.
function(voxlist_install_library name)
  voxlist_export(${name} ${ARGN})
  install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/${name} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/voxlist
    COMPONENT development FILES_MATCHING PATTERN "*.h")
endfunction()

# voxlist_export(ROOM NEEDS...): NEEDS are remembered for voxlistConfig.cmake, which finds their packages.
function(voxlist_export name)
  set_target_properties(voxlist_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS voxlist_${name} EXPORT voxlistTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  list(JOIN ARGN " " needs)
  set_property(GLOBAL APPEND_STRING PROPERTY VOXLIST_NEEDS "set(voxlist_needs_${name} ${needs})\n")
  set_property(GLOBAL APPEND PROPERTY VOXLIST_ROOMS ${name})
endfunction()

# voxlist_install_program(NAME): the desk tool is for people, services are for whoever starts them.
function(voxlist_install_program name)
  set(folder ${CMAKE_INSTALL_LIBEXECDIR}/voxlist)
  if(name STREQUAL voxlist)
    set(folder ${CMAKE_INSTALL_BINDIR})
  endif()
  install(TARGETS ${name}_program RUNTIME DESTINATION ${folder} COMPONENT programs)
endfunction()

# voxlist_install_package(): once, after all rooms.
function(voxlist_install_package)
  get_property(voxlist_rooms GLOBAL PROPERTY VOXLIST_ROOMS)
  list(JOIN voxlist_rooms " " voxlist_rooms)
  get_property(voxlist_needs GLOBAL PROPERTY VOXLIST_NEEDS)
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/voxlistConfig.cmake.in
    ${PROJECT_BINARY_DIR}/voxlistConfig.cmake INSTALL_DESTINATION ${voxlist_cmake_folder})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/voxlistConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(EXPORT voxlistTargets NAMESPACE voxlist:: DESTINATION ${voxlist_cmake_folder} COMPONENT development)
  install(FILES ${PROJECT_BINARY_DIR}/voxlistConfig.cmake ${PROJECT_BINARY_DIR}/voxlistConfigVersion.cmake
    ${PROJECT_SOURCE_DIR}/cmake/Lcm.cmake DESTINATION ${voxlist_cmake_folder} COMPONENT development)
endfunction()
