/* SPDX-License-Identifier: Apache-2.0 OR GPL-2.0-or-later */
#ifndef MILLFORCE_PLANT_LINK_H
#define MILLFORCE_PLANT_LINK_H

#include <stdint.h>

/* The messages between the component millforce_plant in LinuxCNC's servo thread and `millforce plant`, once per servo
 * cycle, over a Unix socket of type SOCK_SEQPACKET. Both run on one machine and are built together: plain structures.
 */

enum { MILLFORCE_PLANT_AXES = 3 };

typedef struct {
    uint32_t cycle_number;
    int32_t kind_of_motion; /* 1: a rapid */
    uint32_t spindle_is_on;
    uint32_t state_code, limit_code, fault_code; /* of the controller, for the record */
    uint32_t has_immersion, has_depth, has_tooth_force;
    uint32_t reserved;
    double period_s;
    double position_mm[MILLFORCE_PLANT_AXES]; /* commanded */
    double spindle_rev_s;                     /* commanded */
    double feed_mm_s;                         /* F of the block in work */
    double override_ratio;                    /* at motion.adaptive-feed */
    double tangential_N, feed_N, estimated_tooth_N;
    double radial_immersion, radial_immersion_sd;
    double axial_depth_mm, axial_depth_sd_mm;
} millforce_plant_command;

typedef struct {
    uint32_t cycle_number;
    uint32_t count, index_count, index_number;
    double position_mm[MILLFORCE_PLANT_AXES];
    double velocity_mm_s[MILLFORCE_PLANT_AXES];
    double current_A[MILLFORCE_PLANT_AXES];
    double spindle_current_A;
    double spindle_rev_s;
    double tooth_force_N; /* largest of a tooth within the cycle, the truth */
} millforce_plant_reply;

#endif
