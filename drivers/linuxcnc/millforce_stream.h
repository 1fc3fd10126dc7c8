/* SPDX-License-Identifier: GPL-2.0-or-later */
#ifndef MILLFORCE_STREAM_H
#define MILLFORCE_STREAM_H

/* One row of the HAL stream from millforce_sample (servo thread) to millforce-hal. */
#define MILLFORCE_STREAM_KEY 0x4D464C4B
#define MILLFORCE_STREAM_DEPTH 4000 /* cycles that millforce-hal may be late */
#define MILLFORCE_STREAM_TYPES "uuuuuufffffffffuf"

enum {
    MILLFORCE_CYCLE,
    MILLFORCE_TIME_US,
    MILLFORCE_COUNT,
    MILLFORCE_INDEX_COUNT,
    MILLFORCE_INDEX_NUMBER,
    MILLFORCE_FLAGS, /* what is present, and the bits below */
    MILLFORCE_SPINDLE_CURRENT,
    MILLFORCE_X_CURRENT,
    MILLFORCE_Y_CURRENT,
    MILLFORCE_Z_CURRENT,
    MILLFORCE_X_VELOCITY,
    MILLFORCE_Y_VELOCITY,
    MILLFORCE_Z_VELOCITY,
    MILLFORCE_FEED,
    MILLFORCE_OPERATOR_LIMIT,
    MILLFORCE_LINE,
    MILLFORCE_DISTANCE_TO_GO,
    MILLFORCE_FIELDS
};

#define MILLFORCE_RAPID 0x100u
#define MILLFORCE_FEED_HOLD 0x200u
#define MILLFORCE_RESET 0x400u

#endif
