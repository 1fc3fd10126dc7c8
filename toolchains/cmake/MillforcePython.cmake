# SPDX-License-Identifier: Apache-2.0
# Whether the Python module (sim/python) is built: MILLFORCE_HAS_PYTHON. A module is a shared library, so all that it
# links is built as position-independent code then.
set(MILLFORCE_PYTHON AUTO CACHE STRING "The Python module: ON, OFF, or AUTO: where pybind11 and numpy are installed")

set(MILLFORCE_HAS_PYTHON OFF)
if(MILLFORCE_PYTHON AND NOT CMAKE_CROSSCOMPILING)
    if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
        set(Python_EXECUTABLE /usr/bin/python3)  # the one that the packages numpy and pybind11 belong to
    endif()
    find_package(Python 3.11 COMPONENTS Interpreter Development.Module NumPy QUIET)
    if(Python_FOUND)
        find_package(pybind11 CONFIG QUIET)
    endif()
    if(Python_FOUND AND pybind11_FOUND)
        set(MILLFORCE_HAS_PYTHON ON)
        set(CMAKE_POSITION_INDEPENDENT_CODE ON)
        add_compile_options(-fno-semantic-interposition)  # functions of a file may be inlined into each other as before
    elseif(NOT MILLFORCE_PYTHON STREQUAL "AUTO")
        message(FATAL_ERROR "MILLFORCE_PYTHON: Python 3.11, numpy or pybind11 is missing: toolchains/install-dependencies --python")
    endif()
endif()
