// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/stm32/fake_can.hpp"
#include "instructions/synthetic_cut.hpp"
#include "override_frame/override_receiver.hpp"
#include "program_status/program_status_frame.hpp"
#include "program_status/tool_frame.hpp"
#include "stm32_h405/analogue_controller.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

/// A board whose registers are memory, and the CNC at the other end of its bus. Time is counted, not waited for.
class BoardBench {
  public:
    using AnalogueController = millforce::stm32_h405::AnalogueController;
    static constexpr std::uint32_t period_us = 1000;
    static constexpr unsigned scans_per_period = 8;

    explicit BoardBench(const millforce::stm32_h405::StartReport& report = {millforce::hal::ResetCause::power_on,
                                                                            millforce::firmware::BlockError::none,
                                                                            false, 0})
        : parameters(millforce::instructions::machine_and_tool()) {
        start(report, nullptr);
    }
    /// With the tools of a block, whose machine and first tool `parameters_of_block` are.
    BoardBench(const AnalogueController::Tools& tools,
               const millforce::firmware::Parameters<float>& parameters_of_block)
        : parameters(parameters_of_block) {
        start({millforce::hal::ResetCause::power_on}, &tools);
    }

    void start(const millforce::stm32_h405::StartReport& report, const AnalogueController::Tools* tools) {
        controller.emplace(peripherals(), wiring);
        controller->start(report, parameters, now_us, tools);
        can.join_bus_with([this] {
            controller->poll(now_us);
            carry();
        });
    }

    /// One period: the inputs change, the converter scans, the controller is polled four times, the bus carries.
    void run_period() {
        turn_spindle();
        if (converter_runs) {
            convert();
        }
        constexpr unsigned polls = 20;  // so many that the slices of an estimate are done within a period
        for (unsigned k = 0; k < polls; ++k) {
            now_us += period_us / polls;
            controller->poll(now_us);
            carry();
        }
    }
    void run(unsigned periods) {
        for (unsigned k = 0; k < periods; ++k) {
            run_period();
        }
    }
    /// Sample `index` of the synthetic cut, over and over with a growing index.
    void run_cut(unsigned periods) {
        for (unsigned k = 0; k < periods; ++k) {
            const auto sample = millforce::instructions::sample_of(cut_index++, parameters);
            currents_A = {sample.spindle_current_A, sample.axis_current_A[0], sample.axis_current_A[1],
                          sample.axis_current_A[2]};
            x_count += millforce::instructions::fast_widening_cut.feed_mm_s * 1e-3F / wiring.axes[0].mm_per_count;
            run_period();
        }
    }
    void carry() {
        can.react();
        for (const millforce::hal::CanFrame& frame : can.sent()) {
            frames.push_back(frame);
            cnc.on_frame(frame, now_us);
        }
    }
    [[nodiscard]] millforce::override_frame::ReceivedOverride seen_by_cnc() const { return cnc.current(now_us); }

    /// The newest EMCY of a reason.
    [[nodiscard]] std::optional<millforce::hal::CanFrame> emergency(millforce::emergency::Reason reason) const {
        std::optional<millforce::hal::CanFrame> found;
        for (const auto& frame : frames) {
            if (frame.id == 0x80U + 126U && frame.data[3] == static_cast<std::uint8_t>(reason)) {
                found = frame;
            }
        }
        return found;
    }
    static std::uint32_t code_of(const millforce::hal::CanFrame& frame) { return frame.data[0] | frame.data[1] * 256U; }
    static std::uint32_t detail_of(const millforce::hal::CanFrame& frame) {
        return frame.data[4] | frame.data[5] * 0x100U | frame.data[6] * 0x1'0000U | frame.data[7] * 0x100'0000U;
    }

    void tell_tool(std::uint32_t number) {
        tell(millforce::program_status::encode_tool(
            number, millforce::program_status::tool_frame_id(millforce::program_status::default_id)));
    }
    void tell_program(const millforce::program_status::ProgramStatusFrame& status) {
        tell(millforce::program_status::encode(status, millforce::program_status::default_id));
    }
    void tell(const millforce::hal::CanFrame& frame) {
        can.arrive(frame.id << 21U, frame.length, word(frame, 0), word(frame, 4));
    }

    millforce::firmware::Parameters<float> parameters;
    millforce::stm32_h405::Wiring wiring{};
    FakeCan can;
    millforce::stm32::TimerRegisters spindle{};
    std::array<millforce::stm32::TimerRegisters, 3> axes{};
    millforce::stm32::AdcRegisters adc{};
    millforce::stm32::AdcCommonRegisters adc_common{};
    millforce::stm32::DmaRegisters dma{};
    millforce::stm32::WatchdogRegisters watchdog{};
    millforce::stm32::PwrRegisters pwr{};
    std::optional<AnalogueController> controller;
    millforce::override_frame::OverrideReceiver cnc{{}};
    std::vector<millforce::hal::CanFrame> frames;

    std::uint64_t now_us = 1'000'000;
    std::array<float, 4> currents_A{};
    bool converter_runs = true;
    float lines_lost = 0.0F;  ///< share of the spindle's counts that do not arrive
    float x_count = 0.0F;
    int cut_index = 0;

  private:
    millforce::stm32_h405::Peripherals peripherals() {
        return {spindle, {&axes[0], &axes[1], &axes[2]}, adc, adc_common, dma, can.registers, watchdog, pwr};
    }
    static std::uint32_t word(const millforce::hal::CanFrame& frame, std::size_t first) {
        return frame.data[first] | frame.data[first + 1] * 0x100U | frame.data[first + 2] * 0x1'0000U |
               frame.data[first + 3] * 0x100'0000U;
    }
    void turn_spindle() {
        constexpr double turns_per_period = 4000.0 / 60.0 * 1e-3;
        const double counts_per_rev = parameters.machine.encoder_counts_per_rev;
        const double before = turns_;
        turns_ += turns_per_period;
        counts_ += turns_per_period * counts_per_rev * (1.0 - static_cast<double>(lines_lost));
        spindle.cnt = static_cast<std::uint32_t>(counts_);
        spindle.sr = 0;
        if (std::floor(turns_) > std::floor(before)) {
            const double since =
                (turns_ - std::floor(turns_)) * counts_per_rev * (1.0 - static_cast<double>(lines_lost));
            spindle.ccr[2] = static_cast<std::uint32_t>(counts_ - since);
            spindle.sr = 1U << 3U;
        }
        axes[0].cnt = static_cast<std::uint32_t>(x_count) & 0xFFFFU;
    }
    void convert() {
        auto& ring = controller->currents().ring();
        const auto values = static_cast<std::uint32_t>(ring.size());
        for (unsigned scan = 0; scan < scans_per_period; ++scan) {
            for (std::size_t k = 0; k < 4; ++k) {
                const auto& channel = wiring.currents.channels[k];
                const float volts = channel.zero_V + currents_A[k] / channel.A_per_V;
                ring[values - dma.stream[0].ndtr] = static_cast<std::uint16_t>(std::lround(volts / 3.3F * 4096.0F));
                const std::uint32_t left = dma.stream[0].ndtr - 1U;
                dma.stream[0].ndtr = left == 0 ? values : left;
            }
        }
    }

    double turns_ = 0.0;
    double counts_ = 0.0;
};
