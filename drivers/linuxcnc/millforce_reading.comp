component millforce_reading """Watches a reading that comes slowly, such as a VFD's current over Modbus, and passes it on while it is fresh.

A driver whose cable is pulled, or that hangs, leaves its last value on the pin for ever. A value alone does not show its
age: a current may rightly stand still. So this component is given some more values that come by the same way, such as
frequency and voltage of the DC link: whenever one of them changes, the reading was made anew. Where none changes for
.B max-age\\fR, the output is not a number. The controller then has no measurement, and holds the feed.

A step from one reading to the next is not handed on as a step: to the controller it would be a force that a cut cannot
have. The output goes there in a straight line, in
.B interval\fR. While it is passed on it alternates by
.B ripple\fR: what stands still the controller takes for a stuck signal, and here that is watched already.

.B age
shows in halshow how long they stand still in normal work: set
.B max-age
to a multiple of it.""";
pin in float in "The reading";
pin in float beside#[3] "What comes by the same way: any change is a sign of life";
pin in bit valid=1 "The driver's own word, e.g. hy_vfd.hycomm-ok";
pin in bit enable "The reading is needed, e.g. spindle.0.on; without it nothing is watched";
pin out float out "The reading, or not a number where it is too old or not valid";
pin out float age "s since the last change";
pin out bit ok "The reading is passed on";
param rw float max_age=0.5 "s";
param rw float interval=0.1 "s between two readings";
param rw float ripple=0.001 "In the reading's unit, far below its resolution";
variable real_t last[4];
variable real_t shown;
variable real_t per_s;
variable int is_up;
function _ fp "Before millforce-sample";
license "GPL";
author "The millforce authors";
;;
/* SPDX-License-Identifier: GPL-2.0-or-later */
#include <rtapi_math.h>

static int is_number(double value) { return value - value == 0.0; }

static double towards(double from, double to, double largest) {
    const double way = to - from;
    return way > largest ? from + largest : way < -largest ? from - largest : to;
}

FUNCTION(_) {
    const double now[4] = {in, beside(0), beside(1), beside(2)};
    const int is_new = now[0] != last[0];
    int k, has_changed = 0;
    for (k = 0; k < 4; ++k) {
        has_changed = has_changed || (is_number(now[k]) && now[k] != last[k]);
        last[k] = now[k];
    }
    age = has_changed || !enable ? 0.0 : age + fperiod;
    ok = valid && age <= max_age;
    if (is_new || !is_number(shown)) per_s = fabs(now[0] - shown) / interval;
    shown = is_number(shown) ? towards(shown, now[0], per_s * fperiod) : now[0];
    is_up = !is_up;
    out = ok ? shown + (is_up ? ripple : 0.0) : (double)NAN;
}
