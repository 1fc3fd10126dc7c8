# SPDX-License-Identifier: Apache-2.0
# The target `cpputest`: the distribution's library on the host, if it is installed; elsewhere built from its sources,
# which toolchains/fetch-cpputest puts into build/cpputest.
if(NOT CMAKE_CROSSCOMPILING)
    # Debian ships no usable CMake config for CppUTest: it is found by name.
    find_library(CPPUTEST_LIBRARY CppUTest)
    find_library(CPPUTEST_EXT_LIBRARY CppUTestExt)
    find_path(CPPUTEST_INCLUDE_DIR CppUTest/TestHarness.h)
    if(NOT CPPUTEST_LIBRARY OR NOT CPPUTEST_EXT_LIBRARY OR NOT CPPUTEST_INCLUDE_DIR)
        message(STATUS "No CppUTest, no tests: toolchains/install-dependencies --tests installs it")
        return()
    endif()
    add_library(cpputest INTERFACE)
    target_include_directories(cpputest SYSTEM INTERFACE ${CPPUTEST_INCLUDE_DIR})
    if(MILLFORCE_SANITIZE)
        # The sanitizers find leaks themselves, and have an operator new of their own.
        target_compile_definitions(cpputest INTERFACE CPPUTEST_MEM_LEAK_DETECTION_DISABLED)
    endif()
    target_link_libraries(cpputest INTERFACE ${CPPUTEST_EXT_LIBRARY} ${CPPUTEST_LIBRARY})
    return()
endif()

set(CPPUTEST_SOURCE ${PROJECT_SOURCE_DIR}/build/cpputest CACHE PATH "Sources of CppUTest 4.0")
if(NOT EXISTS ${CPPUTEST_SOURCE}/include/CppUTest/TestHarness.h)
    message(FATAL_ERROR "${CPPUTEST_SOURCE} has no CppUTest: toolchains/fetch-cpputest build/cpputest")
endif()
file(GLOB cpputest_sources ${CPPUTEST_SOURCE}/src/CppUTest/*.cpp)
add_library(cpputest STATIC ${cpputest_sources} ${CPPUTEST_SOURCE}/src/Platforms/Gcc/UtestPlatform.cpp)
target_include_directories(cpputest SYSTEM PUBLIC ${CPPUTEST_SOURCE}/include)
target_compile_definitions(cpputest PUBLIC
    CPPUTEST_USE_OWN_CONFIGURATION CPPUTEST_STD_CPP_LIB_DISABLED CPPUTEST_MEM_LEAK_DETECTION_DISABLED
    CPPUTEST_USE_LONG_LONG=1)
target_compile_options(cpputest PRIVATE -w)
