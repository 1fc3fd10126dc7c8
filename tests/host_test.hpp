// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CppUTest/TestHarness.h>

/// A case that an emulated processor compiles and does not run: some 10⁵ points, a Monte Carlo of noise, or arithmetic
/// in double. It would take an emulator half a minute, and from the same bits it can only conclude the same. For groups
/// without members.
#if MILLFORCE_IS_HOST
#define HOST_TEST(group, name) TEST(group, name)
#else
#define HOST_TEST(group, name) [[maybe_unused]] static void group##_##name()
#endif
