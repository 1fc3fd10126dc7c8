// SPDX-License-Identifier: Apache-2.0
#include <sys/mman.h>

#include <algorithm>
#include <charconv>
#include <new>
#include <string_view>
#include <vector>

#include "firmware/tick.hpp"
#include "instructions/machine_and_tool.hpp"
#include "override_frame/override_sender.hpp"
#include "override_sender_settings.hpp"
#include "vcan/drives_on_vcan.hpp"

/// Frames lost and the time from SYNC to override, on vcan0: four simulated drives, the controller with the real tick
/// and a CNC that listens, each its own process. What each sent is held against what the others got. Times are those
/// that the kernel gave the SYNC and the override frame.
/// To be run by toolchains/run-with-can. Exit code 1: a frame was lost, or the override never came.

namespace {

using namespace millforce;
using namespace millforce::vcan;

constexpr std::uint32_t sync_period_us = 1000;
constexpr std::size_t drives = 4;
constexpr std::size_t time_capacity = 4'000'000;

/// In memory that the three processes share.
struct Tally {
    FrameCounts drives;
    FrameCounts cnc;
    std::array<std::int64_t, time_capacity> sync_us;
    std::array<std::int64_t, time_capacity> override_us;
};

Tally* shared_tally() {
    void* memory =
        mmap(nullptr, sizeof(Tally), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    return memory == MAP_FAILED ? nullptr : new (memory) Tally;
}

/// Listens for good. One override follows from each SYNC: the n-th belongs to the n-th, however late it is.
void run_cnc(Tally& tally) {
    const PlainSocket socket("vcan0");
    for (;;) {
        hal::CanFrame frame;
        if (!socket.receive(frame)) {
            continue;
        }
        if (is_sync(frame) && tally.cnc.syncs < time_capacity) {
            tally.sync_us[tally.cnc.syncs++] = socket.time_of_last_us();
        } else if (frame.id == override_frame::default_id && tally.cnc.overrides < time_capacity) {
            tally.override_us[tally.cnc.overrides++] = socket.time_of_last_us();
        }
    }
}

cia402::BusSettings figures_settings() {
    cia402::BusSettings settings = bus_settings(drives, sync_period_us);
    for (cia402::DriveSettings& drive : settings.drives) {
        drive.heartbeat_timeout_us = 1'000'000;  // this machine may pause: no drive is to be started anew for that
    }
    return settings;
}

/// The controller: samples into the tick, its override out at once.
class Controller {
  public:
    Controller() : machine(figures_settings()), sender_(sender_settings()), tick_(bench::machine_and_tool()) {
        program_.programmed_feed_mm_s = 20.0F;
        machine.on_sample = [this](const hal::DriveSample& sample) { on_sample(sample); };
    }

    BusOnVcan machine;
    std::uint64_t samples = 0;
    std::uint64_t complete = 0;
    std::uint64_t overrides = 0;

  private:
    static override_frame::OverrideSenderSettings sender_settings() {
        override_frame::OverrideSenderSettings settings = test::an_override_sender();
        settings.period_us = 0;
        return settings;
    }
    void on_sample(const hal::DriveSample& sample) {
        ++samples;
        complete += sample.present == hal::all_present ? 1U : 0U;
        const hal::FeedOverride feed_override = tick_.step(sample, program_);
        const std::uint64_t now_us = socketcan::monotonic_us();
        sender_.update(feed_override, now_us);
        sender_.poll(now_us);
        hal::CanFrame frame;
        while (sender_.take_frame(frame)) {
            overrides += machine.socket.send(frame) && frame.id == override_frame::default_id ? 1U : 0U;
        }
        firmware::finish_work(tick_);
    }

    override_frame::OverrideSender sender_;
    firmware::ForceControlTick<float> tick_;
    hal::ProgramStatus program_{};
};

bool print_count(const char* frames, std::uint64_t sent, std::uint64_t received) {
    std::printf("%-28s %12llu sent %12llu received %8lld lost\n", frames, static_cast<unsigned long long>(sent),
                static_cast<unsigned long long>(received), static_cast<long long>(sent - received));
    return sent == received && sent > 1;
}

void print_latency(const Tally& tally) {
    // Without the last one, whose answers waited until the end.
    std::vector<std::int64_t> latency_us(std::min<std::uint64_t>(tally.cnc.syncs, tally.cnc.overrides) - 1);
    for (std::size_t k = 0; k < latency_us.size(); ++k) {
        latency_us[k] = tally.override_us[k] - tally.sync_us[k];
    }
    std::sort(latency_us.begin(), latency_us.end());
    const auto quantile = [&](double share) {
        const auto place = static_cast<std::size_t>(share * static_cast<double>(latency_us.size()));
        return static_cast<long long>(latency_us[std::min(latency_us.size() - 1, place)]);
    };
    std::printf("SYNC to override, us: median %lld, p99 %lld, p99.9 %lld, max %lld, of %zu\n", quantile(0.5),
                quantile(0.99), quantile(0.999), quantile(1.0), latency_us.size());
}

int measure(int seconds) {
    Tally* tally = shared_tally();
    if (tally == nullptr) {
        std::perror("mmap");
        return 1;
    }
    const Child cnc([&] { run_cnc(*tally); });
    const Child drive_process([&] { run_drives("vcan0", drives, &tally->drives); });
    sleep_ms(300);
    Controller controller;
    BusOnVcan& machine = controller.machine;
    if (!machine.run_until([&] { return machine.all_operational(drives); })) {
        std::fprintf(stderr, "bus_figures: the drives did not start on vcan0\n");
        return 1;
    }
    const std::uint64_t syncs = 1000ULL * static_cast<unsigned>(seconds);
    while (machine.counts.syncs < syncs) {
        machine.run_ms(100);
    }
    // No SYNC any more; what is under way arrives.
    sleep_ms(500);
    machine.drain();
    sleep_ms(500);

    std::printf("4 drives, SYNC every %u us, %llu SYNCs\n", sync_period_us,
                static_cast<unsigned long long>(machine.counts.syncs));
    bool all = print_count("SYNC, controller to drives", machine.counts.syncs, tally->drives.syncs);
    all = print_count("PDOs, drives to controller", tally->drives.pdos, machine.counts.pdos) && all;
    all = print_count("overrides, controller to CNC", controller.overrides, tally->cnc.overrides) && all;
    std::printf("samples: %llu, complete within their SYNC period: %llu; SYNCs skipped: %u; socket overruns: %u\n",
                static_cast<unsigned long long>(controller.samples),
                static_cast<unsigned long long>(controller.complete), machine.sync.skipped(),
                machine.socket.health().overruns);
    if (all) {
        print_latency(*tally);
    }
    return all ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
    int seconds = 10;
    if (count > 1) {
        const std::string_view given = arguments[1];
        const auto read = std::from_chars(given.data(), given.data() + given.size(), seconds);
        if (count > 2 || read.ec != std::errc{} || read.ptr != given.data() + given.size() || seconds < 1 ||
            seconds > 3600) {
            std::fprintf(stderr, "usage: bus_figures [SECONDS of bus time, 1...3600; default 10]\n");
            return 2;
        }
    }
    return measure(seconds);
}
