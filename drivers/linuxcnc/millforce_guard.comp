component millforce_guard """Stands between the force controller and motion.adaptive-feed, in the servo thread.

motion.adaptive-feed takes what it finds: a NaN runs faster than F, a negative number runs the path backwards, and a
controller that died leaves its last value on the pin for ever. This component passes an override on only while the
controller proves that it lives, and only a number from 0 up to
.B max\\fR.

A fault is latched until
.B reset\\fR. Whatever the spindle does meanwhile, a latched fault stays: a machine that was stopped in a cut does not
start again because somebody stopped the spindle.

While the controller lives its override is passed on and its hold is obeyed, whether
.B enable
is true or not; without it nothing is asked of it while
.B enable
is false.

The feed is stopped in two ways at once: an override of 0, which needs M52 P1, and
.B feed-inhibit\\fR, which motion ignores after M51 P0. Where neither acts within
.B stop-time\\fR,
.B machine-ok
falls: it belongs into the emergency-stop chain.

All times are counted in servo cycles.""";
pin in float override "From millforce-hal: the override that the controller asks for";
pin in unsigned heartbeat "From millforce-hal: ticks of the controller; must change within timeout";
pin in bit hold "From millforce-hal: stop the feed, whatever the override says";
pin in bit enable "The controller must be there, e.g. spindle.0.on";
pin in bit reset "Its rising edge clears a latched fault if enable is false or the controller is healthy";
pin in float requested_velocity "motion.requested-vel, to find out that the override is not obeyed (M52 missing); not wired: not checked";
pin in float current_velocity "motion.current-vel, for that check and for machine-ok";
pin in float mm_per_unit=1.0 "millimetres per machine unit, of the two velocities: millforce.mm-per-unit";
pin out float out "To motion.adaptive-feed";
pin out bit feed_inhibit "To motion.feed-inhibit";
pin out bit machine_ok=1 "For the emergency-stop chain: false if the machine keeps moving after a stop was demanded; true again when it is at rest with enable false";
pin out bit ok "The controller lives and its override is a number from 0 on";
pin out bit fault "Latched";
pin out unsigned reason "Reason of the latched fault: 1 never heard, 2 heartbeat stopped or restarted, 3 not a number, 4 negative, 5 not obeyed";
pin out unsigned faults "Number of faults since the start";
param rw float timeout=0.1 "Without a new heartbeat for longer, in s, the controller is dead";
param rw float max=1.0 "Largest override that is passed on";
param rw float idle=1.0 "Override while there is no controller and none is needed";
param rw float max_rise=10.0 "Largest rise per second. A fall is passed on at once: the machine's own acceleration limits it";
param rw bit stop_on_fault=1 "True: a fault stops the feed. False: it goes on at fallback";
param rw float fallback=0.1 "Override at a fault where stop-on-fault is false";
param rw float follow_time=0.1 "Faster than requested-velocity x out and not slowing down for longer, in s: not obeyed";
param rw float stop_time=0.5 "Told to stop and still moving after so long, in s: machine-ok falls";
variable rtapi_u32 last_heartbeat;
variable int heard;
variable int was_reset;
variable int was_held;
variable real_t age_s;
variable real_t disobeyed_s;
variable real_t slowest_mm_s;
variable real_t moving_s;
variable real_t last_out=1.0;
function _ fp "Before motion-controller, so that the override acts in the same cycle";
license "GPL";
author "The millforce authors";
;;
/* SPDX-License-Identifier: GPL-2.0-or-later */
enum { NONE, NEVER_HEARD, HEARTBEAT, NOT_A_NUMBER, NEGATIVE, NOT_OBEYED };

static const double at_rest_mm_s = 0.01;

static int is_number(double value) { return value - value == 0.0; }

FUNCTION(_) {
    const double dt_s = fperiod;
    const double asked = override;  /* read once: another processor may write it meanwhile */
    const rtapi_u32 beat = heartbeat;
    const double speed_mm_s = current_velocity * mm_per_unit, feed_mm_s = requested_velocity * mm_per_unit;
    int alive, sound, began_anew = 0, why = NONE, stopping;
    double target;

    if (!heard && beat == last_heartbeat) {
        age_s = 0.0;
    } else if (beat != last_heartbeat) {
        /* It counts again from the start: a controller that knows nothing of the cut that is under way. */
        began_anew = heard && (rtapi_s32)(beat - last_heartbeat) < 0;
        heard = 1;
        age_s = 0.0;
    } else {
        age_s += dt_s;
    }
    last_heartbeat = beat;
    alive = heard && age_s <= timeout;
    sound = is_number(asked) && asked >= 0.0;

    if (!alive && (enable || was_held)) {  /* it died while it held the feed: that stays so */
        why = heard ? HEARTBEAT : NEVER_HEARD;
    } else if (began_anew && enable) {
        why = HEARTBEAT;
    } else if (alive && !sound) {
        why = is_number(asked) ? NEGATIVE : NOT_A_NUMBER;
    }
    /* Without M52 P1 the machine runs as programmed, whatever the pin says; with it, it slows down. */
    if (enable && feed_mm_s > 0.0 && speed_mm_s > feed_mm_s * last_out * 1.02 + 0.02) {
        if (disobeyed_s == 0.0 || speed_mm_s < 0.98 * slowest_mm_s) {
            slowest_mm_s = speed_mm_s;
            disobeyed_s = 0.0;
        }
        disobeyed_s += dt_s;
        if (disobeyed_s > follow_time) why = NOT_OBEYED;
    } else {
        disobeyed_s = 0.0;
    }
    if (fault && reset && !was_reset && (!enable || (alive && sound))) {
        fault = 0;
        reason = why = NONE;
        disobeyed_s = 0.0;
        was_held = 0;
    }
    was_reset = reset;
    if (why != NONE && !fault) {
        fault = 1;
        reason = why;
        faults++;
    }
    ok = alive && sound;
    if (alive) was_held = hold;

    stopping = fault ? stop_on_fault : alive && hold;
    target = stopping ? 0.0 : fault ? fallback : alive ? asked : idle;
    if (!(target >= 0.0)) target = 0.0;
    if (target > max) target = max;
    if (target > last_out + max_rise * dt_s) target = last_out + max_rise * dt_s;
    last_out = target;
    out = target;
    feed_inhibit = stopping;

    if (stopping && speed_mm_s > at_rest_mm_s) {
        moving_s += dt_s;
        if (moving_s > stop_time) machine_ok = 0;
    } else {
        moving_s = 0.0;
        if (!enable && speed_mm_s <= at_rest_mm_s) machine_ok = 1;
    }
}
