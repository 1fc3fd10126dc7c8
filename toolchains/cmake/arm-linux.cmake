# SPDX-License-Identifier: Apache-2.0
# CMake toolchain file for Arm under Linux: MILLFORCE_CPU is aarch64 or armhf (32-bit, hard float). What is built runs here
# under qemu's user mode.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES MILLFORCE_CPU)

set(MILLFORCE_CPU "aarch64" CACHE STRING "aarch64 or armhf")
if(MILLFORCE_CPU STREQUAL "aarch64")
    set(triplet aarch64-linux-gnu)
    set(CMAKE_SYSTEM_PROCESSOR aarch64)
elseif(MILLFORCE_CPU STREQUAL "armhf")
    set(triplet arm-linux-gnueabihf)
    set(CMAKE_SYSTEM_PROCESSOR arm)
else()
    message(FATAL_ERROR "MILLFORCE_CPU is '${MILLFORCE_CPU}', expected aarch64 or armhf")
endif()

set(CMAKE_C_COMPILER ${triplet}-gcc)
set(CMAKE_CXX_COMPILER ${triplet}-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR "qemu-${CMAKE_SYSTEM_PROCESSOR};-L;/usr/${triplet}")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
