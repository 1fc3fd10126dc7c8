# SPDX-License-Identifier: Apache-2.0
# The libraries for other projects: find_package(millforce), pkg-config, and the core without a library at all.
include(CMakePackageConfigHelpers)

# Each after those that it links. What is for a certain chip or board stays in the tree.
set(libraries hal estimation control firmware estimation_calibration candump cia402 cnc emergency local_link override_frame
    program_status way_window gpio iio socketcan firmware_can firmware_link core_in_one_file)

set(component COMPONENT libmillforce-dev)
set(include_folder ${CMAKE_INSTALL_INCLUDEDIR}/millforce)  # #include "control/feed_law.hpp" as in the tree
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/millforce)

add_custom_target(millforce_libraries)
set(pkg_config_libraries "")
foreach(library IN LISTS libraries)
    install(TARGETS millforce_lib_${library} EXPORT millforceTargets ARCHIVE ${component})
    get_target_property(type millforce_lib_${library} TYPE)
    if(type STREQUAL "STATIC_LIBRARY")
        add_dependencies(millforce_libraries millforce_lib_${library})
        string(PREPEND pkg_config_libraries " -lmillforce_${library}")
        get_target_property(folder millforce_lib_${library} SOURCE_DIR)
        install(DIRECTORY ${folder}/include/ DESTINATION ${include_folder} ${component})
    endif()
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/hal/include/ DESTINATION ${include_folder} ${component})
install(FILES ${PROJECT_SOURCE_DIR}/drivers/cnc/millforce_cnc.h DESTINATION ${include_folder} ${component})

# firmware/core_in_one_file.hpp includes them.
foreach(library IN ITEMS estimation control firmware)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${library}/src DESTINATION ${include_folder}/${library} ${component})
endforeach()

install(EXPORT millforceTargets NAMESPACE millforce:: DESTINATION ${config_folder} ${component})
configure_package_config_file(millforceConfig.cmake.in millforceConfig.cmake INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(millforceConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/millforceConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/millforceConfigVersion.cmake
    DESTINATION ${config_folder} ${component})

# Paths from the place of the file, so that a prefix can be moved.
file(RELATIVE_PATH pkg_config_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(millforce.pc.in millforce.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/millforce.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig ${component})
