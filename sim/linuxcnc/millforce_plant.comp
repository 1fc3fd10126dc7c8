component millforce_plant """A milling machine and its workpiece behind LinuxCNC, simulated by `millforce plant`.

Only for simulated machines: the servo thread waits here for the plant, so that cycles are the plant's time. With
.B lockstep
it also waits until the controller has answered the sample of the last cycle; then a run does not depend on how busy the
computer is. A controller that does not answer within
.B patience
is waited for no longer until it answers again.""";
pin in float mm_per_unit=1.0 "millimetres per machine unit, in which positions and velocities are";
pin in float position_cmd#[3] "Machine units, joint.N.motor-pos-cmd";
pin in s32 motion_type;
pin in bit spindle_on;
pin in float spindle_rps "spindle.0.speed-out-rps";
pin in float requested_velocity "Machine units/s, F of the block in work";
pin in float override "What stands at motion.adaptive-feed";
pin in unsigned state "Of the controller; this and the next ones are for the record";
pin in unsigned limit;
pin in unsigned controller_fault;
pin in float tangential_force;
pin in float feed_force;
pin in float estimated_tooth_force;
pin in bit tooth_force_valid;
pin in float immersion;
pin in float immersion_sd;
pin in bit immersion_valid;
pin in float depth;
pin in float depth_sd;
pin in bit depth_valid;
pin in unsigned sample_cycle "millforce-sample.cycle";
pin in unsigned answered "millforce.answered";
pin in bit connected "millforce.connected";
pin out float position_fb#[3] "Machine units";
pin out float velocity#[3] "Machine units/s";
pin out float current#[3] "A rms";
pin out float spindle_current "A rms";
pin out s32 spindle_count;
pin out s32 spindle_index_count;
pin out unsigned spindle_index_number;
pin out float spindle_speed_rps;
pin out bit spindle_at_speed "Within 2 % of spindle-rps: to spindle.0.at-speed";
pin out float tooth_force "N, the truth";
pin out bit alive "The plant answers";
pin out unsigned cycle;
pin out unsigned unanswered "Cycles that went on without the controller's answer, though it was connected";
param rw bit lockstep=1;
param rw float patience=60.0 "s";
variable int is_given_up;
option singleton yes;
option extra_setup yes;
option extra_cleanup yes;
function _ fp "First of the servo thread";
license "GPL";
author "The millforce authors";
include "plant_link.h";
;;
/* SPDX-License-Identifier: GPL-2.0-or-later */
#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

static char *socket_path;
RTAPI_MP_STRING(socket_path, "Path of the plant's socket");
static int plant = -1;

EXTRA_SETUP() {
    struct sockaddr_un address;
    struct timeval longest = {60, 0};
    (void)__comp_inst;
    (void)prefix;
    (void)extra_arg;
    memset(&address, 0, sizeof address);
    address.sun_family = AF_UNIX;
    if (!socket_path || strlen(socket_path) >= sizeof address.sun_path) {
        rtapi_print_msg(RTAPI_MSG_ERR, "millforce_plant: socket_path= is missing or too long\n");
        return -EINVAL;
    }
    strcpy(address.sun_path, socket_path);
    plant = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    setsockopt(plant, SOL_SOCKET, SO_RCVTIMEO, &longest, sizeof longest);
    if (connect(plant, (struct sockaddr *)&address, sizeof address) != 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "millforce_plant: nobody serves %s: start 'millforce plant' first\n", socket_path);
        return -ECONNREFUSED;
    }
    return 0;
}

EXTRA_CLEANUP() {
    if (plant >= 0) close(plant);
}

static double now_s(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void wait_for_answer(struct __comp_state *__comp_inst) {
    const struct timespec pause = {0, 20000};
    double since_s;
    if (answered == sample_cycle) {
        is_given_up = 0;
        return;
    }
    if (is_given_up) {
        unanswered++;
        return;
    }
    since_s = now_s();
    while (answered != sample_cycle && connected) {
        if (now_s() > since_s + patience) {
            is_given_up = 1;
            return;
        }
        nanosleep(&pause, NULL);
    }
}

static int exchange(const millforce_plant_command *command, millforce_plant_reply *reply) {
    ssize_t length;
    if (send(plant, command, sizeof *command, MSG_NOSIGNAL) != (ssize_t)sizeof *command) return 0;
    do {
        length = recv(plant, reply, sizeof *reply, 0);
    } while (length < 0 && errno == EINTR);
    return length == (ssize_t)sizeof *reply && reply->cycle_number == command->cycle_number;
}

FUNCTION(_) {
    millforce_plant_command command;
    millforce_plant_reply reply;
    int k;
    if (lockstep && connected) wait_for_answer(__comp_inst);
    memset(&command, 0, sizeof command);
    command.cycle_number = ++cycle;
    command.kind_of_motion = motion_type;
    command.spindle_is_on = spindle_on;
    command.state_code = state;
    command.limit_code = limit;
    command.fault_code = controller_fault;
    command.has_immersion = immersion_valid;
    command.has_depth = depth_valid;
    command.has_tooth_force = tooth_force_valid;
    command.period_s = fperiod;
    for (k = 0; k < MILLFORCE_PLANT_AXES; ++k) command.position_mm[k] = position_cmd(k) * mm_per_unit;
    command.spindle_rev_s = spindle_rps;
    command.feed_mm_s = requested_velocity * mm_per_unit;
    command.override_ratio = override;
    command.tangential_N = tangential_force;
    command.feed_N = feed_force;
    command.estimated_tooth_N = estimated_tooth_force;
    command.radial_immersion = immersion;
    command.radial_immersion_sd = immersion_sd;
    command.axial_depth_mm = depth;
    command.axial_depth_sd_mm = depth_sd;
    alive = exchange(&command, &reply);
    if (!alive) return;
    for (k = 0; k < MILLFORCE_PLANT_AXES; ++k) {
        position_fb(k) = reply.position_mm[k] / mm_per_unit;
        velocity(k) = reply.velocity_mm_s[k] / mm_per_unit;
        current(k) = reply.current_A[k];
    }
    spindle_current = reply.spindle_current_A;
    spindle_count = (rtapi_s32)reply.count;
    spindle_index_count = (rtapi_s32)reply.index_count;
    spindle_index_number = reply.index_number;
    spindle_speed_rps = reply.spindle_rev_s;
    spindle_at_speed = fabs(reply.spindle_rev_s - spindle_rps) <= 0.02 * fabs(spindle_rps);
    tooth_force = reply.tooth_force_N;
}
