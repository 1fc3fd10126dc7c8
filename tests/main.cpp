// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/CommandLineTestRunner.h>
#include <CppUTest/MemoryLeakWarningPlugin.h>

int main(int argc, char** argv) {
#if MILLFORCE_IS_HOST
    // Some cases run threads. The leak detector is not made for that unless told so, and crashes now and then.
    MemoryLeakWarningPlugin::turnOnThreadSafeNewDeleteOverloads();
#endif
    return CommandLineTestRunner::RunAllTests(argc, argv);
}
