// The plant's side of the bus, on the Cortex-A53: ELF ORDERS REPORTS, the names of two pipes. Starts the Cortex-R5F; then
// what the host orders goes out by CAN 1, and what CAN 1 hears is reported. Exit codes: 0 the orders ended, 2 no names,
// 3 the R5F does not start, 4 no pipes, 5 no CAN controller.

#include "hal/can_frame.hpp"
#include "target/zcu102/a53.hpp"
#include "target/zcu102/bus_exchange.hpp"
#include "zynqmp/can_controller.hpp"

void* memset(void* to, int value, std::size_t count) {
    auto* byte = static_cast<volatile unsigned char*>(to);
    for (std::size_t k = 0; k < count; ++k) {
        byte[k] = static_cast<unsigned char>(value);
    }
    return to;
}

void* memcpy(void* to, const void* from, std::size_t count) {
    auto* byte = static_cast<volatile unsigned char*>(to);
    const auto* source = static_cast<const unsigned char*>(from);
    for (std::size_t k = 0; k < count; ++k) {
        byte[k] = source[k];
    }
    return to;
}

namespace {

using namespace millforce;

constexpr long sys_open = 0x01;
constexpr long sys_write = 0x05;
constexpr long sys_read = 0x06;
constexpr long sys_get_cmdline = 0x15;
constexpr long read_binary = 1;
constexpr long write_binary = 5;

long address_of(const void* object) { return static_cast<long>(reinterpret_cast<std::uintptr_t>(object)); }

long length_of(const char* text) {
    long length = 0;
    while (text[length] != '\0') {
        ++length;
    }
    return length;
}

char command_line[512];
bus_exchange::Orders orders;
bus_exchange::Report report;

/// Cuts the text at its first space and gives what is behind it.
char* next_word(char* text) {
    while (*text != ' ' && *text != '\0') {
        ++text;
    }
    if (*text == '\0') {
        target::exit_emulator(2);
    }
    *text = '\0';
    return text + 1;
}

long open_file(const char* name, long mode) {
    const long block[] = {address_of(name), mode, length_of(name)};
    return semihosting(sys_open, block);
}

/// False at the end of the file.
bool read_all(long file, void* bytes, long count) {
    while (count > 0) {
        const long block[] = {file, address_of(bytes), count};
        const long left = semihosting(sys_read, block);
        if (left >= count) {
            return false;
        }
        bytes = static_cast<unsigned char*>(bytes) + (count - left);
        count = left;
    }
    return true;
}

bool write_all(long file, const void* bytes, long count) {
    const long block[] = {file, address_of(bytes), count};
    return semihosting(sys_write, block) == 0;
}

/// The generic timer: Arm Architecture Reference Manual D11
std::uint64_t now_us() {
    std::uint64_t count = 0;
    std::uint64_t frequency_hz = 0;
    asm volatile("isb\n mrs %0, cntvct_el0\n mrs %1, cntfrq_el0" : "=r"(count), "=r"(frequency_hz));
    return count * 1'000'000U / frequency_hz;
}

/// The registers are looked at every 3 µs or so: each look costs the emulator more than the waiting, but what the drives
/// latch late is noise in the spindle's acceleration.
void let_time_pass() {
    for (unsigned k = 0; k < 300; ++k) {
        asm volatile("" ::: "memory");
    }
    asm volatile("yield");
}

void send_orders(zynqmp::CanController& can) {
    for (std::uint32_t k = 0; k < orders.count && k < bus_exchange::most_frames; ++k) {
        can.send(orders.frames[k]);
    }
}

/// Until something was heard, or the time is over.
void listen(zynqmp::CanController& can, std::uint64_t end_us) {
    report.count = 0;
    do {
        let_time_pass();
        can.poll();
        report.now_us = now_us();
        hal::CanFrame frame;
        while (report.count < bus_exchange::most_frames && can.receive(frame)) {
            report.heard[report.count] = {report.now_us, frame};
            ++report.count;
        }
    } while (report.count == 0 && report.now_us < end_us);
    report.lost = can.health().unsent + can.health().overruns;
}

}  // namespace

void run() {
    const long line[] = {address_of(command_line), static_cast<long>(sizeof(command_line)) - 1};
    if (semihosting(sys_get_cmdline, line) != 0) {
        target::exit_emulator(2);
    }
    char* const orders_name = next_word(command_line);
    char* const reports_name = next_word(orders_name);
    auto& registers = *reinterpret_cast<zynqmp::CanRegisters*>(zynqmp::address::can1);
    zynqmp::CanController can(registers);
    can.start(zynqmp::kbit_1000);
    can.poll();
    if (!can.is_on_bus()) {
        target::exit_emulator(5);
    }
    const long orders_file = open_file(orders_name, read_binary);
    const long reports_file = open_file(reports_name, write_binary);
    if (orders_file < 0 || reports_file < 0) {
        target::exit_emulator(4);
    }
    if (start_processor(target::cortex_r5f, target::image_of_r5f) != 0) {
        target::exit_emulator(3);
    }
    while (read_all(orders_file, &orders, sizeof(orders))) {
        send_orders(can);
        listen(can, now_us() + orders.wait_us);
        if (!write_all(reports_file, &report, sizeof(report))) {
            break;
        }
    }
    target::exit_emulator(0);
}
