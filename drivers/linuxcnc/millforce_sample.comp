component millforce_sample """Takes what the force controller needs in the servo thread, once per cycle, and hands it to millforce-hal.

The pins are read together, in one cycle, and the sample's time is the cycle's: a program that polls pins from outside
the servo thread would see the current of one cycle and the position of another. What millforce-hal does not fetch in
time is counted in
.B overruns\\fR.""";
pin in float spindle_current "A rms, positive where it drives in the cutting direction; or a torque, see spindle-current-scale";
pin in s32 spindle_count "Encoder counts that never start again, e.g. encoder.0.rawcounts, growing with M3";
pin in float spindle_revs "Instead of spindle-count: revolutions, with counts-per-rev";
pin in s32 spindle_index_count "Count at the last index pulse";
pin in unsigned spindle_index_number "Grows by one at each index pulse; not wired: no index";
pin in float x_current "A rms, positive where it drives the tool in +x";
pin in float y_current;
pin in float z_current;
pin in float x_velocity "Machine units/s, of the tool relative to the workpiece, e.g. joint.0.vel-cmd, or measured";
pin in float y_velocity;
pin in float z_velocity;
pin in float mm_per_unit=1.0 "millimetres per machine unit, of all velocities and of distance-to-go: millforce.mm-per-unit, 25.4 on a machine in inches";
pin in float requested_velocity "F of the block in work in machine units/s: motion.requested-vel. (motion.feed-mm-per-minute contains the override)";
pin in s32 motion_type "motion.motion-type: 1 is a rapid";
pin in s32 program_line "Line of the block in work: motion.program-line; not wired or 0: not known";
pin in float distance_to_go "To that block's end, in machine units: motion.distance-to-go";
pin in float commanded_rps "Speed that the spindle's drive is told, in revolutions/s: spindle.0.speed-out-rps-abs; not wired or 0: not known";
pin in s32 tool_number "Of the tool in the spindle: iocontrol.0.tool-number; not wired or 0: not known";
pin in bit feed_hold "Operator or CNC hold the feed, e.g. halui.program.is-paused";
pin in bit reset "Leaves a fault of the controller; the same signal as the guard's";
pin in float operator_limit=1.0 "Largest override that the operator allows, at most 1";
pin out unsigned cycle "Cycles since the start: the sequence of the newest sample";
pin out unsigned overruns "Samples that were not fetched in time";
param rw float spindle_current_scale=1.0 "A per unit of spindle-current: 1 over the torque constant where it is a torque";
param rw float x_current_scale=1.0;
param rw float y_current_scale=1.0;
param rw float z_current_scale=1.0;
param rw float spindle_current_zero=0.0 "spindle-current at 0 A, in its own unit: a current monitor that is in the middle of its range at rest";
param rw float x_current_zero=0.0;
param rw float y_current_zero=0.0;
param rw float z_current_zero=0.0;
param rw float counts_per_rev=0.0 "Not 0: spindle-revs is used, and this is encoder_counts_per_rev of machine.toml";
param rw float spindle_current_delay=0.0 "spindle-current is that of so many s ago (at most 1 s): all else is handed on as late, so that a sample is of one moment";
param rw unsigned present=31 "What is wired: 1 spindle position + 2 spindle current + 4 x + 8 y + 16 z";
variable rtapi_s64 time_ns;
variable real_t last_requested;
variable int stream_id;
option singleton yes;
option extra_setup yes;
option extra_cleanup yes;
function _ fp "After the drives are read";
license "GPL";
author "The millforce authors";
include "millforce_stream.h";
;;
/* SPDX-License-Identifier: GPL-2.0-or-later */
#include <rtapi_string.h>

enum { PAST = 1024 };  /* cycles; a power of two, so that the index wraps with the cycle */

static hal_stream_t stream;
static int is_open;
static union hal_stream_data past[PAST][MILLFORCE_FIELDS];

/* Everything but the spindle's current is that of `late` cycles ago. */
static void delay(union hal_stream_data *field, rtapi_u32 cycle_number, double late_cycles) {
    const double oldest = cycle_number < PAST ? cycle_number - 1.0 : PAST - 1.0;
    const double late = late_cycles < oldest ? late_cycles : oldest;
    const union hal_stream_data now_cycle = field[MILLFORCE_CYCLE], now_us = field[MILLFORCE_TIME_US];
    const union hal_stream_data current = field[MILLFORCE_SPINDLE_CURRENT];
    memcpy(past[cycle_number % PAST], field, sizeof past[0]);
    if (!(late >= 1.0)) return;
    memcpy(field, past[(cycle_number - (rtapi_u32)late) % PAST], sizeof past[0]);
    field[MILLFORCE_CYCLE] = now_cycle;
    field[MILLFORCE_TIME_US] = now_us;
    field[MILLFORCE_SPINDLE_CURRENT] = current;
}

EXTRA_SETUP() {
    int result = hal_stream_create(&stream, comp_id, MILLFORCE_STREAM_KEY, MILLFORCE_STREAM_DEPTH, MILLFORCE_STREAM_TYPES);
    (void)prefix;
    (void)extra_arg;
    is_open = result == 0;
    return result;
}

EXTRA_CLEANUP() {
    if (is_open) hal_stream_destroy(&stream);
}

FUNCTION(_) {
    union hal_stream_data field[MILLFORCE_FIELDS];
    long count = spindle_count;
    if (counts_per_rev > 0.0) {
        double counts = spindle_revs * counts_per_rev;
        count = (long)counts - (counts < (long)counts);
    }
    /* motion shows the velocity of a block one cycle before its kind: a rapid's must not be taken for an F. */
    const double feed = requested_velocity < last_requested ? requested_velocity : last_requested;
    last_requested = requested_velocity;
    time_ns += period;
    cycle++;
    field[MILLFORCE_CYCLE].u = cycle;
    field[MILLFORCE_TIME_US].u = (rtapi_u32)(time_ns / 1000);
    field[MILLFORCE_COUNT].u = (rtapi_u32)count;
    field[MILLFORCE_INDEX_COUNT].u = (rtapi_u32)spindle_index_count;
    field[MILLFORCE_INDEX_NUMBER].u = spindle_index_number;
    field[MILLFORCE_FLAGS].u = (present & 31u) | (motion_type == 1 ? MILLFORCE_RAPID : 0u) |
                               (feed_hold ? MILLFORCE_FEED_HOLD : 0u) | (reset ? MILLFORCE_RESET : 0u);
    field[MILLFORCE_SPINDLE_CURRENT].f = (spindle_current - spindle_current_zero) * spindle_current_scale;
    field[MILLFORCE_X_CURRENT].f = (x_current - x_current_zero) * x_current_scale;
    field[MILLFORCE_Y_CURRENT].f = (y_current - y_current_zero) * y_current_scale;
    field[MILLFORCE_Z_CURRENT].f = (z_current - z_current_zero) * z_current_scale;
    field[MILLFORCE_X_VELOCITY].f = x_velocity * mm_per_unit;
    field[MILLFORCE_Y_VELOCITY].f = y_velocity * mm_per_unit;
    field[MILLFORCE_Z_VELOCITY].f = z_velocity * mm_per_unit;
    field[MILLFORCE_FEED].f = feed * mm_per_unit;
    field[MILLFORCE_OPERATOR_LIMIT].f = operator_limit;
    field[MILLFORCE_LINE].u = program_line > 0 ? (rtapi_u32)program_line : 0u;
    field[MILLFORCE_DISTANCE_TO_GO].f = distance_to_go * mm_per_unit;
    field[MILLFORCE_TOOL].u = tool_number > 0 ? (rtapi_u32)tool_number : 0u;
    field[MILLFORCE_COMMANDED_SPEED].f = commanded_rps * 6.283185307179586;
    delay(field, cycle, spindle_current_delay / fperiod + 0.5);
    if (hal_stream_write(&stream, field) < 0) overruns++;
}
