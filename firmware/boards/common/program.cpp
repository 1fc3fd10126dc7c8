// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include "common/processor.hpp"

extern "C" {
extern std::uint32_t _data_load, _data_start, _data_end, _bss_start, _bss_end;
extern std::uint32_t _stack_limit, _stack_top;
using Routine = void (*)();
extern const Routine __preinit_array_start[], __preinit_array_end[], __init_array_start[], __init_array_end[];
extern void* const __dso_handle;
void* const __dso_handle = nullptr;
}

namespace {

constexpr std::uint32_t paint = 0xA5A5'5A5AU;

void prepare_memory() {
    const std::uint32_t* from = &_data_load;
    for (std::uint32_t* to = &_data_start; to < &_data_end; ++to) {
        *to = *from++;
    }
    for (std::uint32_t* to = &_bss_start; to < &_bss_end; ++to) {
        *to = 0;
    }
}

void call(const Routine* from, const Routine* to) {
    for (; from != to; ++from) {
        (*from)();
    }
}

std::uint32_t bytes_between(const std::uint32_t* from, const std::uint32_t* to) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(to) - reinterpret_cast<std::uintptr_t>(from));
}

}  // namespace

namespace millforce::board {

void start_program() {
    prepare_memory();
    paint_stack();
    call(__preinit_array_start, __preinit_array_end);
    call(__init_array_start, __init_array_end);
    run_image();
}

void paint_stack() {
    std::uint32_t here = 0;
    asm volatile("mov %0, sp" : "=r"(here));
    constexpr std::uint32_t own_frame = 64;
    for (std::uint32_t* word = &_stack_limit; reinterpret_cast<std::uint32_t>(word) < here - own_frame; ++word) {
        *word = paint;
    }
}

std::uint32_t stack_size_bytes() {
    return bytes_between(&_stack_limit, &_stack_top);
}

std::uint32_t untouched_stack_bytes() {
    const std::uint32_t* word = &_stack_limit;
    while (word < &_stack_top && *word == paint) {
        ++word;
    }
    return bytes_between(&_stack_limit, word);
}

}  // namespace millforce::board
