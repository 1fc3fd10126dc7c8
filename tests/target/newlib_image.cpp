// SPDX-License-Identifier: Apache-2.0
// A test program with a C library and a heap of its own, under semihosting: what CppUTest needs.
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>

#include "common/processor.hpp"
#include "target/semihosting.hpp"

int main(int argc, char** argv);

extern "C" {
void initialise_monitor_handles();
void _init() {}
void _fini() {}
void* _sbrk(std::ptrdiff_t increment);
extern char _end, _ram_end;
}

/// The C library's own would see the stack, which lies below the heap, as a collision.
void* _sbrk(std::ptrdiff_t increment) {
    static char* top = &_end;
    if (increment > &_ram_end - top) {
        errno = ENOMEM;
        return reinterpret_cast<void*>(-1);
    }
    void* const block = top;
    top += increment;
    return block;
}

void millforce::board::run_image() {
    constexpr int most_arguments = 16;
    static char text[512];
    static char* arguments[most_arguments + 1];
    initialise_monitor_handles();
    millforce::target::read_command_line(text, sizeof(text));
    int count = 0;
    for (char* word = std::strtok(text, " "); word != nullptr && count < most_arguments;
         word = std::strtok(nullptr, " ")) {
        arguments[count++] = word;
    }
    std::exit(main(count, arguments));
}
