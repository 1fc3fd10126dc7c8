component millforce_slow_drive """Stands in for a drive that is read over a serial line: its outputs are its inputs of the last reading, in steps.

Only for simulated machines.""";
pin in float in#[4];
pin out float out#[4];
pin in bit hangs "No more readings";
param rw float interval=0.1 "s between two readings";
param rw float step=0.1 "Resolution of the readings";
variable real_t since_s;
function _ fp "After the plant";
license "GPL";
author "The millforce authors";
;;
/* SPDX-License-Identifier: GPL-2.0-or-later */
#include <rtapi_math.h>

FUNCTION(_) {
    int k;
    since_s += fperiod;
    if (hangs || since_s < interval) return;
    since_s = 0.0;
    for (k = 0; k < 4; ++k) out(k) = step * floor(in(k) / step + 0.5);
}
