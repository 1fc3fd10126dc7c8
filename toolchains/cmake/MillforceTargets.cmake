# SPDX-License-Identifier: Apache-2.0
# Two kinds of targets. Core targets (hal, estimation, control, the tick) run on the drive controller: no exceptions,
# no RTTI, and a build-time search for the words that the core must not contain. Host targets may use all of C++20.
# A target includes its own headers and those of what it links, nothing else: in the core the include paths see to that,
# for folders of the host check-includes does.

find_package(Eigen3 3.3 REQUIRED NO_MODULE)
if(MILLFORCE_BUILD_PROGRAM AND NOT CMAKE_CROSSCOMPILING)
    find_package(fmt REQUIRED)
endif()

set(MILLFORCE_WARNINGS
    -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wdouble-promotion -Wold-style-cast
    -Wnon-virtual-dtor -Woverloaded-virtual -Wnull-dereference)
if(PROJECT_IS_TOP_LEVEL)
    list(APPEND MILLFORCE_WARNINGS -Werror)  # another project's compiler may know more warnings
endif()

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

add_custom_target(millforce_core_rules
    COMMAND ${CMAKE_COMMAND}
            -DSOURCE_DIR=${PROJECT_SOURCE_DIR}
            -P ${PROJECT_SOURCE_DIR}/toolchains/cmake/CoreRules.cmake
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

# millforce_names(<name>): the library millforce_lib_<name> is millforce::<name> for every project that builds or installs
# it, and <name> inside this one. Another project may have a target `control` of its own.
function(millforce_names name)
    add_library(millforce::${name} ALIAS millforce_lib_${name})
    set_target_properties(millforce_lib_${name} PROPERTIES EXPORT_NAME ${name} OUTPUT_NAME millforce_${name})
    if(PROJECT_IS_TOP_LEVEL)
        add_library(${name} ALIAS millforce_lib_${name})
    endif()
endfunction()

# Headers that are included as "folder/header.hpp", in the tree and where they are installed (package/Library.cmake); and
# what compiles them as this project does.
function(millforce_public_headers target visibility folder)
    target_compile_features(${target} ${visibility} cxx_std_20)
    target_compile_options(${target} INTERFACE -ffp-contract=off)
    target_include_directories(${target} ${visibility}
        $<BUILD_INTERFACE:${folder}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/millforce>)
endfunction()

# In place of names of this project's targets, those that hold in every project.
function(millforce_link target)
    foreach(link IN LISTS ARGN)
        if(TARGET millforce::${link})
            set(link millforce::${link})
        endif()
        target_link_libraries(${target} PUBLIC ${link})
    endforeach()
endfunction()

# millforce_core(<folder> SOURCES ... LINKS ...)
function(millforce_core name)
    cmake_parse_arguments(ARG "" "" "SOURCES;LINKS" ${ARGN})
    set(target millforce_lib_${name})
    add_library(${target} STATIC ${ARG_SOURCES})
    millforce_names(${name})
    millforce_public_headers(${target} PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/include)
    target_compile_options(${target} PRIVATE -fno-exceptions -fno-rtti -fno-threadsafe-statics -fno-math-errno)
    millforce_link(${target} ${ARG_LINKS})
    millforce_target_warnings(${target})
    add_dependencies(${target} millforce_core_rules)
    # The estimator is where a tick's time goes. With an FPU the rest has time, and flash is scarce.
    if(MILLFORCE_CPU STREQUAL "cortex-m4f" AND NOT name STREQUAL "estimation")
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
    millforce_link(${target} fmt::fmt ${ARG_LINKS})
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
