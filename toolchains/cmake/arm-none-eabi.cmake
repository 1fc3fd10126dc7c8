# SPDX-License-Identifier: Apache-2.0
# CMake toolchain file for bare-metal Arm: MILLFORCE_CPU is cortex-m3, cortex-m4f or cortex-r5f.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES MILLFORCE_CPU)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_EXECUTABLE_SUFFIX_CXX .elf)

set(MILLFORCE_CPU "cortex-m4f" CACHE STRING "cortex-m3, cortex-m4f or cortex-r5f")
if(MILLFORCE_CPU STREQUAL "cortex-m3")
    set(cpu_flags "-mcpu=cortex-m3 -mthumb -mfloat-abi=soft")
elseif(MILLFORCE_CPU STREQUAL "cortex-m4f")
    set(cpu_flags "-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard")
elseif(MILLFORCE_CPU STREQUAL "cortex-r5f")
    set(cpu_flags "-mcpu=cortex-r5 -marm -mfpu=vfpv3-d16 -mfloat-abi=hard")
else()
    message(FATAL_ERROR "MILLFORCE_CPU is '${MILLFORCE_CPU}', expected cortex-m3, cortex-m4f or cortex-r5f")
endif()

# What the core is built with on the host too (MillforceTargets.cmake) and, for images, what sheds unused code.
set(CMAKE_C_FLAGS_INIT "${cpu_flags} -ffunction-sections -fdata-sections")
set(CMAKE_CXX_FLAGS_INIT "${cpu_flags} -ffunction-sections -fdata-sections -fno-exceptions -fno-rtti -fno-use-cxa-atexit -fno-threadsafe-statics")
# -O3: the tick is a tenth shorter than with -O2. What only a start needs is marked cold, and compiled for size.
set(CMAKE_CXX_FLAGS_RELEASE_INIT "-O3 -DNDEBUG -fno-math-errno")
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG -fno-math-errno" CACHE STRING "")
set(CMAKE_EXE_LINKER_FLAGS_INIT "${cpu_flags} -nostartfiles -Wl,--gc-sections -Wl,--fatal-warnings")

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
