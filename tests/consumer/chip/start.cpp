// SPDX-License-Identifier: Apache-2.0
// The start of a Cortex-M4F that another project brings along: vectors, FPU, constructors, and main() with what the
// debugger gives as arguments.

#include <cstdint>
#include <cstdlib>

extern "C" {
extern std::uint32_t stack_top;
void initialise_monitor_handles();  // of newlib: printf over semihosting
void __libc_init_array();
void _init() {}
void _fini() {}
}

int main(int argc, char** argv);

namespace {

[[noreturn]] void reset() {
    volatile auto& coprocessor_access = *reinterpret_cast<std::uint32_t*>(0xE000ED88);
    coprocessor_access = coprocessor_access | 0xFU << 20U;
    asm volatile("dsb\nisb");
    initialise_monitor_handles();
    __libc_init_array();
    char name[] = "consumer";
    char* words[] = {name, name, nullptr};
    const int status = main(1, words) | main(2, words);
    std::exit(status);
}

[[noreturn]] void fault() {
    std::_Exit(3);
}

struct Vectors {
    std::uint32_t* stack;
    void (*handlers[15])();
};
[[gnu::section(".vectors"), gnu::used]] const Vectors vectors{&stack_top, {reset, fault, fault, fault, fault, fault}};

}  // namespace
