# SPDX-License-Identifier: Apache-2.0
# Two kinds of targets. Core targets (hal, estimation, control, the tick) run on the drive controller: no exceptions,
# no RTTI, and a build-time search for the words that the core must not contain. Host targets may use all of C++20.
# A target includes its own headers and those of what it links, nothing else: in the core the include paths see to that,
# for folders of the host check-includes does.

find_package(Eigen3 3.3 REQUIRED NO_MODULE)
if(NOT CMAKE_CROSSCOMPILING)
    find_package(fmt REQUIRED)
endif()

set(MILLFORCE_WARNINGS
    -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wdouble-promotion -Wold-style-cast
    -Wnon-virtual-dtor -Woverloaded-virtual -Wnull-dereference -Werror)

# One rounding per operation on every processor, so that golden vectors compare bit for bit.
add_compile_options(-ffp-contract=off)

if(MILLFORCE_SANITIZE STREQUAL "thread")
    set(sanitizers thread)
elseif(MILLFORCE_SANITIZE)
    set(sanitizers address,undefined)
endif()
if(MILLFORCE_SANITIZE)
    # Without RTTI an object of the core does not know its type: vptr is out.
    add_compile_options(-fsanitize=${sanitizers} -fno-sanitize=vptr,null,object-size -fno-sanitize-recover=all -fno-omit-frame-pointer)
    add_link_options(-fsanitize=${sanitizers})
endif()
if(MILLFORCE_FUZZ)
    add_compile_options(-fsanitize=fuzzer-no-link)
endif()

add_custom_target(core_rules ALL
    COMMAND ${CMAKE_COMMAND}
            -DSOURCE_DIR=${CMAKE_SOURCE_DIR}
            -P ${CMAKE_SOURCE_DIR}/toolchains/cmake/CoreRules.cmake
    COMMENT "Searching the core for heap, exceptions, RTTI and double"
    VERBATIM)

function(millforce_target_warnings target)
    target_compile_options(${target} PRIVATE
        ${MILLFORCE_WARNINGS}
        # Eigen's products inline into bounds that GCC 12 cannot see; the sanitizer build checks them for real.
        $<$<CXX_COMPILER_ID:GNU>:-Wno-null-dereference>)
endfunction()

# Most of a source's compile time goes into its headers: up to eight sources of a folder share them. The preset `tidy`
# joins whole folders.
function(millforce_joined_sources target)
    if(NOT CMAKE_UNITY_BUILD)
        set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    endif()
endfunction()

# millforce_core(<folder> SOURCES ... LINKS ...)
function(millforce_core target)
    cmake_parse_arguments(ARG "" "" "SOURCES;LINKS" ${ARGN})
    add_library(${target} STATIC ${ARG_SOURCES})
    add_library(millforce::${target} ALIAS ${target})
    target_include_directories(${target} PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/include)
    target_compile_options(${target} PRIVATE -fno-exceptions -fno-rtti -fno-threadsafe-statics -fno-math-errno)
    target_link_libraries(${target} PUBLIC ${ARG_LINKS})
    millforce_target_warnings(${target})
    add_dependencies(${target} core_rules)
    # The estimator is where a tick's time goes. With an FPU the rest has time, and flash is scarce.
    if(MILLFORCE_CPU STREQUAL "cortex-m4f" AND NOT target STREQUAL "estimation")
        target_compile_options(${target} PRIVATE -Os)
    endif()
    if(CMAKE_CROSSCOMPILING)
        set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL TRUE)  # only what an image or a test links
    else()
        millforce_joined_sources(${target})
    endif()
endfunction()

# millforce_host_library(<prefix> <folder> [HOT] LINKS ...): all sources of a folder beside the caller, as
# <prefix>_<folder>. HOT: the simulation's inner loops; -O3 pays for its compile time there, elsewhere -O1 is enough.
function(millforce_host_library prefix folder)
    cmake_parse_arguments(ARG "HOT" "" "LINKS" ${ARGN})
    file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
    set(target ${prefix}_${folder})
    add_library(${target} STATIC ${sources})
    target_include_directories(${target} PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
    target_link_libraries(${target} PUBLIC fmt::fmt ${ARG_LINKS})
    millforce_target_warnings(${target})
    set(hot)
    if(ARG_HOT)
        set(hot HOT)
    endif()
    millforce_host_optimisation(${target} ${hot})
    millforce_joined_sources(${target})
endfunction()

# millforce_host_optimisation(<target> [HOT])
function(millforce_host_optimisation target)
    cmake_parse_arguments(ARG "HOT" "" "" ${ARGN})
    set(level O1)
    if(ARG_HOT)
        set(level O3)
    endif()
    if(CMAKE_BUILD_TYPE STREQUAL "Release")
        target_compile_options(${target} PRIVATE -${level}
            # At -O1 GCC 12 sees copies beyond the small buffer of std::string that are never made (GCC bug 105651).
            $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds>
            $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow>)
    endif()
endfunction()
