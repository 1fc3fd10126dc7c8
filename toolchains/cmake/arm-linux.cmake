# SPDX-License-Identifier: Apache-2.0
# CMake toolchain file for 64-bit Arm under Linux: the plant on the Cortex-A53 of a Zynq UltraScale+, which an emulator runs.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES MILLFORCE_CPU)

set(MILLFORCE_CPU "aarch64" CACHE STRING "aarch64")
set(triplet aarch64-linux-gnu)
set(CMAKE_SYSTEM_PROCESSOR aarch64)

set(CMAKE_C_COMPILER ${triplet}-gcc)
set(CMAKE_CXX_COMPILER ${triplet}-g++)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
