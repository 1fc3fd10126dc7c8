// SPDX-License-Identifier: Apache-2.0
// The controller of an STM32F405: composition root, and what happens when the processor itself fails.

#include "common/processor.hpp"
#include "stm32/clock.hpp"
#include "stm32/parameter_flash.hpp"
#include "stm32/timers.hpp"
#include "stm32_h405/analogue_controller.hpp"

namespace {

using namespace millforce;
using stm32_h405::AnalogueController;

template <typename Registers>
Registers& at(std::uintptr_t address) {
    return *reinterpret_cast<Registers*>(address);
}

/// Outlives the reset.
constexpr std::uint32_t fault_was_kept = 0xFA17'FA17U;
struct KeptFault {
    std::uint32_t magic;
    std::uint32_t program_counter;
};
[[gnu::section(".noinit")]] KeptFault kept_fault;

AnalogueController* running_controller = nullptr;

[[noreturn]] void reset_processor() {
    constexpr std::uintptr_t aircr = 0xE000'ED0CU;
    constexpr std::uint32_t key_and_request = 0x05FA'0004U;
    asm volatile("dsb" ::: "memory");
    at<stm32::Register>(aircr) = key_and_request;
    for (;;) {
    }
}

/// Without the crystal there is no bit rate, and no CAN: silence holds the feed. Another start may be luckier.
void start_clock() {
    constexpr std::uint32_t patience = 200'000;  // some 0.1 s at 16 MHz
    stm32::Clock clock(at<stm32::RccRegisters>(stm32::address::rcc), at<stm32::FlashRegisters>(stm32::address::flash),
                       at<stm32::PwrRegisters>(stm32::address::pwr), stm32_h405::crystal_hz, patience);
    while (!clock.is_settled()) {
        clock.poll();
    }
    if (clock.state() != stm32::ClockState::running) {
        reset_processor();
    }
}

stm32_h405::Peripherals peripherals() {
    namespace address = stm32::address;
    return {.spindle_timer = at<stm32::TimerRegisters>(address::tim2),
            .axis_timers = {&at<stm32::TimerRegisters>(address::tim3), &at<stm32::TimerRegisters>(address::tim4),
                            &at<stm32::TimerRegisters>(address::tim1)},
            .adc = at<stm32::AdcRegisters>(address::adc1),
            .adc_common = at<stm32::AdcCommonRegisters>(address::adc_common),
            .dma = at<stm32::DmaRegisters>(address::dma2),
            .can = at<stm32::CanRegisters>(address::can1),
            .watchdog = at<stm32::WatchdogRegisters>(address::iwdg),
            .pwr = at<stm32::PwrRegisters>(address::pwr)};
}

firmware::BlockError load(firmware::Parameters<float>& parameters, firmware::BlockTools& tools) {
    constexpr std::uintptr_t sector_10 = 0x080C'0000U;
    constexpr std::uintptr_t sector_11 = 0x080E'0000U;
    constexpr std::size_t slot_words = (firmware::largest_block_bytes + 3U) / 4U;
    const auto go_on = [] { return true; };
    stm32::ParameterFlash flash(at<stm32::FlashRegisters>(stm32::address::flash),
                                {10, {&at<stm32::Register>(sector_10), slot_words}},
                                {11, {&at<stm32::Register>(sector_11), slot_words}}, go_on);
    return firmware::ParameterStore<decltype(flash)>(flash).load(parameters, tools);
}

stm32_h405::StartReport report_of_start() {
    stm32_h405::StartReport report;
    report.cause = stm32::take_reset_cause(at<stm32::RccRegisters>(stm32::address::rcc));
    report.had_processor_fault = kept_fault.magic == fault_was_kept && report.cause == hal::ResetCause::software;
    report.fault_program_counter = kept_fault.program_counter;
    kept_fault.magic = 0;
    return report;
}

/// 64 bits out of the timer's 32; at least once in 71 minutes.
std::uint64_t now_us() {
    static std::uint32_t last_us = 0;
    static std::uint32_t wraps = 0;
    const std::uint32_t us = at<stm32::TimerRegisters>(stm32::address::tim5).cnt;
    wraps += us < last_us ? 1U : 0U;
    last_us = us;
    return static_cast<std::uint64_t>(wraps) << 32U | us;
}

}  // namespace

void millforce::board::run_image() {
    stm32_h405::StartReport report = report_of_start();
    start_clock();
    stm32_h405::enable_peripherals(at<stm32::RccRegisters>(stm32::address::rcc));
    stm32::watch_supply(at<stm32::PwrRegisters>(stm32::address::pwr));
    stm32_h405::connect_pins(at<stm32::GpioRegisters>(stm32::address::gpio_a),
                             at<stm32::GpioRegisters>(stm32::address::gpio_b),
                             at<stm32::GpioRegisters>(stm32::address::gpio_c));
    stm32::start_microsecond_clock(at<stm32::TimerRegisters>(stm32::address::tim5), stm32::apb1_timer_clock_hz);
    static firmware::Parameters<float> parameters;
    firmware::BlockTools tools_of_block;
    report.parameters = load(parameters, tools_of_block);
    static const AnalogueController::Tools tools(tools_of_block, parameters);
    static AnalogueController controller(peripherals(), stm32_h405::Wiring{});
    controller.start(report, parameters, now_us(), tools_of_block.size() > 0 ? &tools : nullptr);
    stm32::start_trigger(at<stm32::TimerRegisters>(stm32::address::tim8), stm32::apb2_timer_clock_hz,
                         stm32_h405::scan_rate_hz);
    running_controller = &controller;
    for (;;) {
        controller.poll(now_us());
    }
}

void millforce::board::on_processor_fault(const FaultRecord& record) {
    constexpr std::uint32_t non_maskable = 2;  // the crystal stopped: the bit rate is wrong from now on
    kept_fault = {fault_was_kept, record.program_counter};
    if (running_controller != nullptr && record.exception == non_maskable) {
        running_controller->fall_silent();
    } else if (running_controller != nullptr) {
        // Some milliseconds: three frames at 125 kbit/s. The watchdog would end it, too.
        std::uint32_t looks = 100'000;
        running_controller->give_up(emergency::Reason::processor_fault, record.program_counter,
                                    [&looks] { return --looks != 0; });
    }
    reset_processor();
}
