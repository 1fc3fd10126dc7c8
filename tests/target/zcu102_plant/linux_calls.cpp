// SPDX-License-Identifier: Apache-2.0
// The few system calls that a static C++ program makes, served on a bare Cortex-A53: memory out of what lies behind the
// image, files of the host to read, a console to write to, the generic timer as clock. Any other is named on the
// console and ends the run. Runs inside the exception: without the FPU, whose registers are the program's.

#include <asm/stat.h>
#include <asm/unistd.h>
#include <linux/fcntl.h>
#include <linux/futex.h>
#include <linux/stat.h>

#include <cstdint>

#include "target/zcu102/a53.hpp"
#include "target/zcu102_plant/host_calls.hpp"

extern "C" {
extern char _end[];                // behind the image
extern const char __ehdr_start[];  // its ELF header
}

namespace {

using namespace millforce;

constexpr std::uint64_t end_of_memory = 0x0800'0000;  // 128 MiB, as QEMU gives where it is not told
constexpr std::uint64_t stack_bytes = 0x0010'0000;
constexpr std::uint64_t page_bytes = 4096;

constexpr long no_such_file = -2;
constexpr long out_of_memory = -12;
constexpr long bad_argument = -22;
constexpr long no_such_call = -38;

constexpr long sys_open = 0x01;
constexpr long sys_close = 0x02;
constexpr long sys_write = 0x05;
constexpr long sys_read = 0x06;
constexpr long sys_seek = 0x0A;
constexpr long sys_file_length = 0x0C;
constexpr long sys_get_command_line = 0x15;

unsigned long calls_of_host = 0;

long address_of(const void* object) {
    return static_cast<long>(reinterpret_cast<std::uintptr_t>(object));
}

long host(long operation, long first = 0, long second = 0, long third = 0) {
    const long block[] = {first, second, third};
    ++calls_of_host;
    return semihosting(operation, block);
}

long length_of(const char* text) {
    long length = 0;
    while (text[length] != '\0') {
        ++length;
    }
    return length;
}

// Files: descriptors below `first_file` are the console, the others the host's handles.

constexpr long first_file = 16;
constexpr unsigned most_files = 16;
struct File {
    long position;
    long length;
};
File files[most_files];

bool is_file(long descriptor) {
    return descriptor >= first_file && descriptor < first_file + most_files;
}

long open_file(const char* name, long flags) {
    constexpr long access_mode = 3;
    constexpr long read_binary = 1;
    if ((flags & access_mode) != 0) {
        return bad_argument;
    }
    const long handle = host(sys_open, address_of(name), read_binary, length_of(name));
    if (handle < 0 || handle >= most_files) {
        return no_such_file;
    }
    files[handle] = {0, host(sys_file_length, handle)};
    return first_file + handle;
}

long close_file(long descriptor) {
    return is_file(descriptor) ? host(sys_close, descriptor - first_file) : 0;
}

long read_file(long descriptor, std::uint64_t bytes, long count) {
    if (!is_file(descriptor)) {
        return 0;
    }
    const long left = host(sys_read, descriptor - first_file, static_cast<long>(bytes), count);
    files[descriptor - first_file].position += count - left;
    return count - left;
}

long seek_file(long descriptor, long offset, long whence) {
    constexpr long origin_count = 3;
    if (!is_file(descriptor) || whence < 0 || whence >= origin_count) {
        return bad_argument;
    }
    File& file = files[descriptor - first_file];
    const long origins[origin_count] = {0, file.position, file.length};
    file.position = origins[whence] + offset;
    host(sys_seek, descriptor - first_file, file.position);
    return file.position;
}

/// Of a file by its name, or by its descriptor where it has none; the console's is not known.
long tell_status(const char* name, long descriptor, struct stat& status) {
    const bool is_named = *name != '\0';
    const long file = is_named ? open_file(name, O_RDONLY) : descriptor;
    if (!is_file(file)) {
        return no_such_file;
    }
    auto* const words = reinterpret_cast<std::uint64_t*>(&status);
    for (unsigned k = 0; k < sizeof(status) / sizeof(*words); ++k) {
        words[k] = 0;
    }
    status.st_mode = S_IFREG | S_IRUSR;
    status.st_size = files[file - first_file].length;
    status.st_blksize = static_cast<int>(page_bytes);
    return is_named ? close_file(file) : 0;
}

long write_console(std::uint64_t bytes, long count) {
    static long console = -1;
    constexpr long write_text = 4;
    if (console < 0) {
        const char name[] = ":tt";
        console = host(sys_open, address_of(name), write_text, length_of(name));
    }
    return count - host(sys_write, console, static_cast<long>(bytes), count);
}

struct Slice {
    std::uint64_t bytes;
    long count;
};

template <typename Transfer>
long for_each_slice(const Slice* slices, long count, Transfer transfer) {
    long sum = 0;
    for (long k = 0; k < count; ++k) {
        const long done = transfer(slices[k].bytes, slices[k].count);
        sum += done;
        if (done < slices[k].count) {
            break;
        }
    }
    return sum;
}

void say(const char* text) {
    write_console(reinterpret_cast<std::uintptr_t>(text), length_of(text));
}

void say(unsigned long number) {
    char text[] = "0x0000000000000000";
    for (unsigned k = 17; k > 1; --k, number >>= 4U) {
        text[k] = "0123456789abcdef"[number & 15U];
    }
    say(text);
}

// Memory: the program break grows from the image up, mappings from the stack down.

std::uint64_t break_end = 0;
std::uint64_t mappings_begin = end_of_memory - stack_bytes;

long move_break(std::uint64_t end) {
    if (break_end == 0) {
        break_end = (reinterpret_cast<std::uintptr_t>(_end) + page_bytes) & ~(page_bytes - 1U);
    }
    if (end >= reinterpret_cast<std::uintptr_t>(_end) && end < mappings_begin) {
        break_end = end;
    }
    return static_cast<long>(break_end);
}

/// What is unmapped is lost: an allocator maps large blocks alone, and few.
long map_memory(std::uint64_t bytes) {
    const std::uint64_t whole = (bytes + page_bytes - 1U) & ~(page_bytes - 1U);
    if (whole < bytes || whole > mappings_begin - static_cast<std::uint64_t>(move_break(0))) {
        return out_of_memory;
    }
    mappings_begin -= whole;
    return static_cast<long>(mappings_begin);
}

long tell_time(std::uint64_t* time) {
    std::uint64_t count = 0;
    std::uint64_t frequency_hz = 0;
    asm volatile("isb\n mrs %0, cntvct_el0\n mrs %1, cntfrq_el0" : "=r"(count), "=r"(frequency_hz));
    time[0] = count / frequency_hz;
    time[1] = count % frequency_hz * 1'000'000'000U / frequency_hz;
    return 0;
}

// The first stack: argc, argv, environment, auxiliary vector, by the ABI of the processor.

char command_line[1024];
std::uint64_t start_values[64];

/// Words of the command line, cut at its spaces; the first is not ours.
unsigned take_words(std::uint64_t* words, unsigned most) {
    host(sys_get_command_line, address_of(command_line), sizeof(command_line) - 1);
    unsigned count = 0;
    for (char* next = command_line; *next != '\0' && count < most;) {
        words[count++] = reinterpret_cast<std::uintptr_t>(next);
        while (*next != ' ' && *next != '\0') {
            ++next;
        }
        if (*next == ' ') {
            *next++ = '\0';
        }
    }
    return count;
}

}  // namespace

extern "C" {

std::uint64_t* first_stack();
long serve(const long* x);
[[noreturn]] void end_by_fault(unsigned long syndrome, unsigned long at, unsigned long address);

std::uint64_t* first_stack() {
    constexpr unsigned most_words = 16;
    std::uint64_t words[most_words];
    const unsigned count = take_words(words, most_words);
    std::uint64_t* next = start_values;
    *next++ = count;
    for (unsigned k = 0; k < count; ++k) {
        *next++ = words[k];
    }
    *next++ = 0;
    *next++ = 0;
    const auto header = reinterpret_cast<std::uintptr_t>(__ehdr_start);
    const auto* const sizes = reinterpret_cast<const std::uint16_t*>(__ehdr_start);
    constexpr std::uint64_t float_and_simd = 3;
    const std::uint64_t auxiliary[] = {
        3,  header + *reinterpret_cast<const std::uint64_t*>(__ehdr_start + 32),  // AT_PHDR: e_phoff
        4,  sizes[27],                                                            // AT_PHENT: e_phentsize
        5,  sizes[28],                                                            // AT_PHNUM: e_phnum
        6,  page_bytes,
        16, float_and_simd,  // AT_HWCAP
        25, header,          // AT_RANDOM: no secret is kept
        0,  0};
    for (const std::uint64_t value : auxiliary) {
        *next++ = value;
    }
    const auto words_on_stack = static_cast<std::uint64_t>(next - start_values + 1) & ~std::uint64_t{1};
    auto* const stack = reinterpret_cast<std::uint64_t*>(end_of_memory) - words_on_stack;
    for (unsigned k = 0; k < words_on_stack; ++k) {
        stack[k] = start_values[k];
    }
    return stack;
}

/// x0…x8 as the program set them: arguments and number.
long serve(const long* x) {
    const auto* const slices = reinterpret_cast<const Slice*>(x[1]);
    switch (x[8]) {
        case __NR_openat:
            return open_file(reinterpret_cast<const char*>(x[1]), x[2]);
        case __NR_close:
            return close_file(x[0]);
        case __NR_lseek:
            return seek_file(x[0], x[1], x[2]);
        case __NR_read:
            return read_file(x[0], static_cast<std::uint64_t>(x[1]), x[2]);
        case __NR_readv:
            return for_each_slice(slices, x[2], [&](auto bytes, long count) { return read_file(x[0], bytes, count); });
        case __NR_write:
            return write_console(static_cast<std::uint64_t>(x[1]), x[2]);
        case __NR_writev:
            return for_each_slice(slices, x[2], write_console);
        case __NR_brk:
            return move_break(static_cast<std::uint64_t>(x[0]));
        case __NR_mmap:
            return x[4] < 0 ? map_memory(static_cast<std::uint64_t>(x[1])) : bad_argument;
        case __NR_clock_gettime:
            return tell_time(reinterpret_cast<std::uint64_t*>(x[1]));
        case __NR_set_tid_address:
            return 1;
        case __NR_newfstatat:
            return tell_status(reinterpret_cast<const char*>(x[1]), x[0], *reinterpret_cast<struct stat*>(x[2]));
        case __NR_futex:
            return (x[1] & FUTEX_CMD_MASK) == FUTEX_WAKE ? 0 : no_such_call;  // nobody waits: one thread
        case __NR_rseq:
        case __NR_prlimit64:
        case __NR_readlinkat:
        case __NR_getrandom:
            return no_such_call;  // the C library does without
        case __NR_munmap:
        case __NR_mprotect:
        case __NR_set_robust_list:
            return 0;
        case __NR_exit:
        case __NR_exit_group:
            target::exit_emulator(x[0]);
        default:
            break;
    }
    say("system call ");
    say(static_cast<unsigned long>(x[8]));
    say(" is not served\n");
    target::exit_emulator(6);
}

void end_by_fault(unsigned long syndrome, unsigned long at, unsigned long address) {
    say("fault ");
    say(syndrome);
    say(" at ");
    say(at);
    say(", address ");
    say(address);
    say("\n");
    target::exit_emulator(68);
}

unsigned long host_calls() {
    return calls_of_host;
}

}  // extern "C"
