// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <barrier>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string_view>
#include <thread>

#include "estimation/number/fixed_point.hpp"
#include "firmware/parameters_in.hpp"
#include "firmware/ready_tools.hpp"
#include "firmware/tool_tick.hpp"
#include "instructions/machine_and_tool.hpp"
#include "override_frame/override_receiver.hpp"
#include "override_frame/override_sender.hpp"
#include "override_sender_settings.hpp"
#include "soak/endurance.hpp"
#include "soak/memory_in_use.hpp"

namespace {

using namespace millforce;
using namespace millforce::soak;

constexpr const char* usage =
    "usage: soak [HOURS]        hours of simulated cutting, 2 to 1000 (100)\n"
    "\n"
    "Mills one part of 30 s over and over, by the tick in float and by the tick in fixed point, each on a thread. The\n"
    "counters of the machine begin 20 s before they wrap: the time in µs, the encoder's count, the number of the "
    "index\n"
    "pulse. The tick in float changes its tool each hour, by numbers up to the largest, and sends its override by the\n"
    "frame whose counter wraps. The signals of the part are recorded: the feed does not follow the override.\n"
    "\n"
    "SIGINT or SIGTERM ends it after the present hour, not before the second, with what has been milled until then.\n"
    "\n"
    "Exit code: 0 no fault, no frame refused, no memory taken after the first hour, and the last part of each hour\n"
    "answered as in the first: in float bit for bit, in fixed point within 0.00001 of the override, a tenth of what "
    "the\n"
    "frame can tell apart; 1 one of these does not hold, or it was told to end; 2 bad usage.\n";

/// In fixed point what is learnt in air goes round within the last digits, and does not come to rest on one value.
constexpr float within_fixed = 1e-5F;
constexpr float exactly = 0.0F;

template <typename Tick>
Answer answer_of(const Tick& tick, const hal::FeedOverride& output) {
    const auto& e = tick.estimate();
    const auto shown = [](const auto& value, bool is_valid) { return is_valid ? static_cast<float>(value) : 0.0F; };
    return {output,
            {shown(e.engagement.radial_immersion, e.engagement.immersion_valid),
             shown(e.engagement.axial_depth_mm, e.engagement.depth_valid),
             shown(e.tooth_force_N.value, e.tooth_force_N.valid)}};
}

/// The tick in float of the tool in the spindle, and the frame that carries its override.
class FloatMill {
  public:
    explicit FloatMill(const firmware::Parameters<float>& parameters)
        : tools_(memory_), tick_(parameters, &tools_), sender_(test::an_override_sender()), receiver_({}) {
        for (const std::uint32_t number : numbers) {
            tools_.add(number, parameters);
        }
    }
    void begin_hour(std::uint64_t hour) { number_ = numbers[hour % numbers.size()]; }
    void step(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
        changes_ += tick_.follow_tool(number_, hal::axes_rest(sample.axis_velocity_mm_s)) ? 1U : 0U;
        output_ = firmware::step_and_work(tick_, sample, program);
        send();
    }
    [[nodiscard]] Answer answer() const { return answer_of(tick_.of_tool(), output_); }
    [[nodiscard]] std::uint64_t tool_changes() const { return changes_; }
    [[nodiscard]] std::uint64_t frames_refused() const { return refused_; }

  private:
    static constexpr std::array<std::uint32_t, 3> numbers{0xFFFFFFFFU, 1U, 0x80000000U};

    void send() {
        time_us_ += RepeatedPart::sample_interval_us;
        sender_.update(output_, time_us_);
        sender_.poll(time_us_);
        for (hal::CanFrame frame; sender_.take_frame(frame);) {
            receiver_.on_frame(frame, time_us_);
        }
        refused_ += time_us_ > trusted_from_us && !receiver_.current(time_us_).is_alive ? 1U : 0U;
    }

    static constexpr std::uint64_t trusted_from_us = 100'000;

    std::array<firmware::ReadyTool, 3> memory_;
    firmware::ReadyTools tools_;
    firmware::ToolTick tick_;
    override_frame::OverrideSender sender_;
    override_frame::OverrideReceiver receiver_;
    hal::FeedOverride output_{};
    std::uint32_t number_ = numbers[0];
    std::uint64_t changes_ = 0;
    std::uint64_t refused_ = 0;
    std::uint64_t time_us_ = 0;
};

class FixedMill {
  public:
    explicit FixedMill(const firmware::Parameters<float>& parameters)
        : tick_(firmware::parameters_in<estimation::Fixed>(parameters)) {}
    void begin_hour(std::uint64_t) {}
    void step(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
        output_ = firmware::step_and_work(tick_, sample, program);
    }
    [[nodiscard]] Answer answer() const { return answer_of(tick_, output_); }

  private:
    firmware::SmallTick<estimation::Fixed> tick_;
    hal::FeedOverride output_{};
};

/// An encoder whose counts per revolution divide 2³², and one whose counts do not.
firmware::Parameters<float> machine_with(std::uint32_t counts_per_rev) {
    firmware::Parameters<float> parameters = bench::machine_and_tool();
    parameters.machine.encoder_counts_per_rev = counts_per_rev;
    return parameters;
}

bool print(std::string_view name, const Endured& e, const RepeatedPart::Wraps& wraps, float tolerance) {
    fmt::print(
        "{}\n  {} samples, {} of them with an immersion; override {:.3f} to {:.3f} in the cuts\n"
        "  wrapped: time {} times, encoder count {}, index number {}\n"
        "  {} samples with a fault or a hold, {} with a heartbeat out of sequence\n"
        "  {} answers compared with the first hour's: {} differ, the override by {:.2g} at most, in the last hour by "
        "{:.2g}\n",
        name, e.samples, e.with_immersion, static_cast<double>(e.override_range[0]),
        static_cast<double>(e.override_range[1]), wraps.time, wraps.encoder_count, wraps.index_number, e.faults,
        e.wrong_heartbeat, e.compared, e.different, static_cast<double>(e.largest_override_difference),
        static_cast<double>(e.override_difference_of_last_hour));
    const bool has_cut = e.with_immersion > e.samples / 4;
    const bool has_wrapped = wraps.time > 0 && wraps.encoder_count > 0 && wraps.index_number > 0;
    return has_cut && has_wrapped && e.faults == 0 && e.wrong_heartbeat == 0 && e.compared > 0 &&
           e.largest_override_difference <= tolerance && (tolerance > exactly || e.different == 0);
}

bool print(const MemoryInUse& first, const MemoryInUse& last) {
    fmt::print(
        "memory after the first hour, and the most after any later one\n  allocations {} and {}, heap {} and {} bytes, "
        "resident {} and {} "
        "KiB\n",
        first.allocations, last.allocations, first.heap_bytes, last.heap_bytes, first.resident_KiB, last.resident_KiB);
    return first.allocations == last.allocations && first.heap_bytes == last.heap_bytes &&
           first.resident_KiB == last.resident_KiB;
}

std::atomic<bool> is_told_to_end{false};

void end_after_this_hour(int /*signal*/) {
    is_told_to_end = true;
}

/// On a terminal. Nothing is allocated, for that would be found.
void show_progress(std::uint64_t milled, std::uint64_t hours) {
    static const bool is_terminal = ::isatty(STDERR_FILENO) != 0;
    if (is_terminal) {
        (void)std::fprintf(stderr, "\r%llu of %llu h%s", static_cast<unsigned long long>(milled),
                           static_cast<unsigned long long>(hours), milled == hours ? "\n" : "");
    }
}

int run(std::uint64_t hours) {
    const firmware::Parameters<float> of_float = machine_with(8192);
    const firmware::Parameters<float> of_fixed = machine_with(4000);
    const RepeatedPart float_part(of_float, 1);
    const RepeatedPart fixed_part(of_fixed, 1);
    const auto float_mill = std::make_unique<FloatMill>(of_float);
    const auto fixed_mill = std::make_unique<FixedMill>(of_fixed);
    Endurance float_endurance(*float_mill, float_part);
    Endurance fixed_endurance(*fixed_mill, fixed_part);
    const auto start = std::chrono::steady_clock::now();
    std::barrier both(2);  // where they meet, one of them measures
    std::array<MemoryInUse, 2> memory;
    std::uint64_t milled = 0;
    std::atomic<bool> goes_on{true};
    std::jthread beside([&] {
        for (std::uint64_t hour = 0; goes_on; ++hour) {
            fixed_endurance.run_hour(hour);
            both.arrive_and_wait();
            both.arrive_and_wait();
        }
    });
    while (goes_on) {
        float_endurance.run_hour(milled);
        both.arrive_and_wait();
        const MemoryInUse now = memory_in_use();
        memory[0] = milled == 0 ? now : memory[0];
        memory[1] = milled == 0 ? now : largest(memory[1], now);
        ++milled;
        show_progress(milled, hours);
        goes_on = milled < hours && (milled < 2 || !is_told_to_end);
        both.arrive_and_wait();
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    const auto parts = static_cast<std::uint64_t>(static_cast<double>(milled) * 3600.0 / float_part.duration_s() + 0.5);
    bool holds = print("float", float_endurance.endured(), float_part.wraps_after(parts), exactly);
    fmt::print("  {} tool changes, {} samples whose override the receiver did not trust\n", float_mill->tool_changes(),
               float_mill->frames_refused());
    holds = float_mill->tool_changes() >= milled && float_mill->frames_refused() == 0 && holds;
    holds = print("fixed point", fixed_endurance.endured(), fixed_part.wraps_after(parts), within_fixed) && holds;
    holds = print(memory[0], memory[1]) && holds;
    fmt::print("{} h in {:.1f} s: {}\n", milled, took.count(),
               holds ? "all as in the first hour" : "NOT as in the first hour");
    if (milled < hours) {
        fmt::print("told to end before {} h\n", hours);
    }
    return holds && milled == hours ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 2 && (std::strcmp(argv[1], "--help") == 0 || std::strcmp(argv[1], "-h") == 0)) {
        fmt::print("{}", usage);
        return 0;
    }
    std::uint64_t hours = 100;
    const char* const end = argc > 1 ? argv[1] + std::strlen(argv[1]) : nullptr;
    const bool is_number = argc < 2 || std::from_chars(argv[1], end, hours).ptr == end;
    if (argc > 2 || !is_number || hours < 2 || hours > 1000) {
        fmt::print(stderr, "soak: '{}' is no number of hours from 2 to 1000\n{}", argc > 1 ? argv[argc - 1] : "",
                   usage);
        return 2;
    }
    std::signal(SIGINT, end_after_this_hour);
    std::signal(SIGTERM, end_after_this_hour);
    return run(hours);
}
