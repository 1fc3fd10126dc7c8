// SPDX-License-Identifier: Apache-2.0
#include "target/semihosting.hpp"

#include <cstring>

#include "common/processor.hpp"

namespace millforce::target {

namespace {

constexpr std::uint32_t sys_open = 0x01;
constexpr std::uint32_t sys_write0 = 0x04;
constexpr std::uint32_t sys_write = 0x05;
constexpr std::uint32_t sys_read = 0x06;
constexpr std::uint32_t sys_get_cmdline = 0x15;
constexpr std::uint32_t sys_exit_extended = 0x20;

struct Block {
    std::uint32_t first;
    std::uint32_t second;
    std::uint32_t third;
};

std::uint32_t address_of(const void* object) {
    return reinterpret_cast<std::uint32_t>(object);
}

}  // namespace

std::int32_t semihosting(std::uint32_t operation, const void* argument) {
    register std::uint32_t r0 asm("r0") = operation;
    register const void* r1 asm("r1") = argument;
#if defined(__thumb__)
    asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
#else
    asm volatile("svc 0x123456" : "+r"(r0) : "r"(r1) : "memory", "lr");
#endif
    return static_cast<std::int32_t>(r0);
}

void write_text(const char* text) {
    semihosting(sys_write0, text);
}

void write_number(std::uint32_t value) {
    char digits[11]{};
    std::size_t first = sizeof(digits) - 1;
    do {
        digits[--first] = static_cast<char>('0' + value % 10U);
        value /= 10U;
    } while (value != 0);
    write_text(digits + first);
}

void exit_emulator(int code) {
    constexpr std::uint32_t application_exit = 0x20026;
    const Block block{application_exit, static_cast<std::uint32_t>(code), 0};
    semihosting(sys_exit_extended, &block);
    for (;;) {
    }
}

HostFile::HostFile(const char* path, OpenMode mode) : handle_(-1) {
    const Block block{address_of(path), static_cast<std::uint32_t>(mode),
                      static_cast<std::uint32_t>(std::strlen(path))};
    handle_ = semihosting(sys_open, &block);
}

bool HostFile::read(void* bytes, std::size_t count) {
    auto* next = static_cast<unsigned char*>(bytes);
    while (count > 0) {
        const Block block{static_cast<std::uint32_t>(handle_), address_of(next), count};
        const auto left = static_cast<std::size_t>(semihosting(sys_read, &block));
        if (left >= count) {
            return false;
        }
        next += count - left;
        count = left;
    }
    return true;
}

bool HostFile::write(const void* bytes, std::size_t count) {
    const Block block{static_cast<std::uint32_t>(handle_), address_of(bytes), count};
    return semihosting(sys_write, &block) == 0;
}

void read_command_line(char* text, std::size_t capacity) {
    text[0] = '\0';
    const Block block{address_of(text), capacity - 1, 0};
    if (semihosting(sys_get_cmdline, &block) != 0) {
        text[0] = '\0';
    }
}

}  // namespace millforce::target

namespace {

void write_hex(const char* name, std::uint32_t value) {
    char digits[] = " 0x00000000";
    for (unsigned k = 0; k < 8; ++k) {
        digits[10 - k] = "0123456789abcdef"[value >> (4 * k) & 15U];
    }
    millforce::target::write_text(name);
    millforce::target::write_text(digits);
}

}  // namespace

/// Exit code 64 + the number of the exception; a test that provokes a fault expects it.
void millforce::board::on_processor_fault(const millforce::board::FaultRecord& record) {
    write_hex("processor fault: exception", record.exception);
    write_hex(", pc", record.program_counter);
    write_hex(", lr", record.link_register);
    write_hex(", sp", record.stack_pointer);
    write_hex(", cfsr", record.status);
    write_hex(", address", record.address);
    millforce::target::write_text("\n");
    millforce::target::exit_emulator(64 + static_cast<int>(record.exception));
}
