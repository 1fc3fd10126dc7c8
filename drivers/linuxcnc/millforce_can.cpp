// SPDX-License-Identifier: GPL-2.0-or-later
// millforce-can: the override of `millforce run` on a CAN bus as HAL pins, and what the program does back to the bus.
// For a machine whose drives are on that bus and whose controller is another computer. In place of millforce-hal; the
// rest is the same: it decides nothing, and millforce_guard in the servo thread watches the pin `heartbeat`.
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include <hal.h>

#include "millforce_cnc.h"
#include "millforce_program.h"

namespace {

constexpr const char* component_name = "millforce-can";
constexpr long wait_ns = 1'000'000;
constexpr real_t micrometres_per_mm = 1000.0;
constexpr real_t s_per_min = 60.0;
constexpr real_t largest_speed = 4.0e9;  // 0.001/min

/// Wraps after 71.6 minutes.
std::uint32_t now_us() {
    return static_cast<std::uint32_t>(monotonic_us());
}

/// In HAL's shared memory, and nowhere else: linking a pin to a signal moves the pointer here.
struct Pins {
    hal_float_t* ratio;
    hal_u32_t* heartbeat;
    hal_bit_t* hold;
    hal_bit_t* connected;
    hal_u32_t* state;
    hal_u32_t* fault;
    hal_u32_t* refused;
    hal_u32_t* dropped;
    hal_float_t* requested_velocity;
    hal_float_t* mm_per_unit;
    hal_float_t* operator_override;
    hal_s32_t* motion_type;
    hal_s32_t* tool_number;
    hal_float_t* commanded_rps;
    hal_s32_t* program_line;
    hal_float_t* distance_to_go;
    hal_bit_t* feed_hold;
    hal_bit_t* reset;
};

int export_pins(Pins& p, int component) {
    const auto f32 = [&](hal_pin_dir_t direction, hal_float_t** pin, const char* name) {
        return hal_pin_float_newf(direction, pin, component, "%s.%s", component_name, name);
    };
    const auto u32 = [&](hal_u32_t** pin, const char* name) {
        return hal_pin_u32_newf(HAL_OUT, pin, component, "%s.%s", component_name, name);
    };
    const auto s32 = [&](hal_s32_t** pin, const char* name) {
        return hal_pin_s32_newf(HAL_IN, pin, component, "%s.%s", component_name, name);
    };
    const auto bit = [&](hal_pin_dir_t direction, hal_bit_t** pin, const char* name) {
        return hal_pin_bit_newf(direction, pin, component, "%s.%s", component_name, name);
    };
    const int failed =
        f32(HAL_OUT, &p.ratio, "override") | u32(&p.heartbeat, "heartbeat") | bit(HAL_OUT, &p.hold, "hold") |
        bit(HAL_OUT, &p.connected, "connected") | u32(&p.state, "state") | u32(&p.fault, "fault") |
        u32(&p.refused, "refused") | u32(&p.dropped, "dropped") |
        f32(HAL_IN, &p.requested_velocity, "requested-velocity") | f32(HAL_IN, &p.mm_per_unit, "mm-per-unit") |
        f32(HAL_IN, &p.operator_override, "operator-override") | s32(&p.motion_type, "motion-type") |
        s32(&p.tool_number, "tool-number") | s32(&p.program_line, "program-line") |
        f32(HAL_IN, &p.commanded_rps, "commanded-rps") | f32(HAL_IN, &p.distance_to_go, "distance-to-go") |
        bit(HAL_IN, &p.feed_hold, "feed-hold") | bit(HAL_IN, &p.reset, "reset");
    if (failed == 0) {
        *p.hold = true;
        *p.mm_per_unit = 1.0;
        *p.operator_override = 1.0;
    }
    return failed;
}

int open_can(const char* interface) {
    const int can = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex(interface));
    const can_filter filters[] = {{MILLFORCE_OVERRIDE_ID, CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG},
                                  {0x700U + MILLFORCE_OVERRIDE_NODE, CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG}};
    if (can >= 0 && address.can_ifindex != 0 &&
        setsockopt(can, SOL_CAN_RAW, CAN_RAW_FILTER, filters, sizeof filters) == 0 &&
        bind(can, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
        return can;
    }
    if (can >= 0) {
        close(can);
    }
    return -1;
}

millforce_can_frame in_our_form(const can_frame& frame) {
    millforce_can_frame ours{};
    ours.id = frame.can_id & CAN_SFF_MASK;
    ours.is_extended = (frame.can_id & CAN_EFF_FLAG) != 0;
    ours.is_remote = (frame.can_id & CAN_RTR_FLAG) != 0;
    ours.length = frame.can_dlc;
    std::copy(frame.data, frame.data + sizeof ours.data, ours.data);
    return ours;
}

/// Whole units within 0…largest; a NaN is 0.
std::uint32_t whole(real_t value, real_t largest) {
    return value > 0.0 ? static_cast<std::uint32_t>(std::min(value, largest) + 0.5) : 0U;
}

std::uint32_t number_of(std::int32_t pin) {
    return pin > 0 ? static_cast<std::uint32_t>(pin) : 0U;
}

class Bridge {
  public:
    Bridge(int can, const Pins& pins) : can_(can), pins_(pins) {
        millforce_receiver_start(&receiver_, millforce_default_settings());
        millforce_status_start(&status_sender_);
        millforce_tool_start(&tool_sender_);
        millforce_speed_start(&speed_sender_);
        millforce_position_start(&position_sender_);
    }

    void step() {
        pollfd descriptor{can_, POLLIN, 0};
        const timespec wait{0, wait_ns};
        if (ppoll(&descriptor, 1, &wait, nullptr) > 0 && (descriptor.revents & POLLIN) == 0) {
            nanosleep(&wait, nullptr);  // an interface that is down would make this a busy loop
        }
        can_frame frame{};
        while (read(can_, &frame, sizeof frame) == sizeof frame) {
            take(in_our_form(frame));
        }
        set_pins();
        report();
    }

  private:
    /// The bus counts to 65 535, the guard to 2^32: it takes a number that falls for a restarted controller.
    void take(const millforce_can_frame& frame) {
        const std::uint32_t before = receiver_.newest.counter;
        const millforce_result result = millforce_on_frame(&receiver_, &frame, now_us());
        if (result == millforce_counter_jumped) {
            heartbeat_ = 0;
        } else if (result == millforce_ok) {
            heartbeat_ += (receiver_.newest.counter - before) & 0xFFFFU;
        } else if (result != millforce_not_this_frame && result != millforce_counter_repeated) {
            *pins_.refused = *pins_.refused + 1;
        }
    }

    void set_pins() {
        const millforce_received now = millforce_now(&receiver_, now_us());
        *pins_.ratio = static_cast<real_t>(now.ratio) / MILLFORCE_RATIO_OF_1;
        *pins_.hold = now.hold;
        *pins_.state = now.state;
        *pins_.fault = now.fault;
        *pins_.connected = now.is_alive;
        *pins_.heartbeat = heartbeat_;
    }

    void report() {
        const real_t feed_mm_min = *pins_.requested_velocity * *pins_.mm_per_unit * s_per_min;
        millforce_program_status status{};
        status.feed = whole(feed_mm_min * MILLFORCE_FEED_UNITS_PER_MM_MIN, MILLFORCE_LARGEST_FEED);
        status.operator_override = whole(*pins_.operator_override * 100.0, 255.0);
        status.is_rapid = *pins_.motion_type == 1;
        status.is_feed_held = *pins_.feed_hold;
        status.resets_fault = *pins_.reset;
        millforce_can_frame frame{};
        if (millforce_status_due(&status_sender_, &status, now_us(), &frame)) {
            send(frame);
        }
        if (millforce_tool_due(&tool_sender_, number_of(*pins_.tool_number), now_us(), &frame)) {
            send(frame);
        }
        const real_t speed_rpm = *pins_.commanded_rps * s_per_min;
        const std::uint32_t speed = whole(speed_rpm * MILLFORCE_SPEED_UNITS_PER_RPM, largest_speed);
        if (millforce_speed_due(&speed_sender_, speed, now_us(), &frame)) {
            send(frame);
        }
        report_position();
    }

    /// A machine that does not wire the line spares the bus these frames.
    void report_position() {
        const millforce_position position = read_position();
        millforce_can_frame frame{};
        knows_lines_ = knows_lines_ || position.line != 0;
        if (knows_lines_ && millforce_position_due(&position_sender_, &position, now_us(), &frame)) {
            send(frame);
        }
    }

    /// The servo thread may come between two pins: a distance counts with the line that it was read with.
    millforce_position read_position() const {
        millforce_position position{};
        std::uint32_t line = number_of(*pins_.program_line);
        for (int attempt = 0; attempt < 3 && position.line == 0; ++attempt) {
            const real_t distance = *pins_.distance_to_go * *pins_.mm_per_unit * micrometres_per_mm;
            position.distance =
                distance >= 0.0 ? whole(distance, MILLFORCE_DISTANCE_NOT_KNOWN) : MILLFORCE_DISTANCE_NOT_KNOWN;
            const std::uint32_t line_before = line;
            line = number_of(*pins_.program_line);
            position.line = line == line_before ? line : 0;
        }
        return position;
    }

    /// What cannot be sent is dropped: the next one is newer.
    void send(const millforce_can_frame& ours) {
        can_frame frame{};
        frame.can_id = ours.id;
        frame.can_dlc = MILLFORCE_FRAME_BYTES;
        std::copy(ours.data, ours.data + sizeof ours.data, frame.data);
        if (write(can_, &frame, sizeof frame) != sizeof frame) {
            *pins_.dropped = *pins_.dropped + 1;
        }
    }

    int can_;
    const Pins& pins_;
    millforce_receiver receiver_{};
    millforce_status_sender status_sender_{};
    millforce_tool_sender tool_sender_{};
    millforce_speed_sender speed_sender_{};
    millforce_position_sender position_sender_{};
    bool knows_lines_ = false;
    std::uint32_t heartbeat_ = 0;
};

int run(int component, const char* interface) {
    auto* pins = static_cast<Pins*>(hal_malloc(sizeof(Pins)));
    if (pins == nullptr || export_pins(*pins, component) != 0) {
        fprintf(stderr, "millforce-can: no memory for HAL pins\n");
        return 1;
    }
    const int can = open_can(interface);
    if (can < 0) {
        fprintf(stderr, "millforce-can: %s: %s, expected a CAN interface\n", interface, strerror(errno));
        return 1;
    }
    hal_ready(component);
    Bridge bridge(can, *pins);
    while (stop_asked == 0) {
        bridge.step();
    }
    close(can);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2 || argv[1][0] == '\0' || strlen(argv[1]) >= IFNAMSIZ) {
        fprintf(stderr, "usage: millforce-can INTERFACE    the CAN interface, e.g. can0\n");
        return 2;
    }
    ask_to_stop_on_signals();
    const int component = hal_init(component_name);
    if (component < 0) {
        fprintf(stderr, "millforce-can: no HAL: is LinuxCNC running, and no other millforce-can?\n");
        return 1;
    }
    const int result = run(component, argv[1]);
    hal_exit(component);
    return result;
}
