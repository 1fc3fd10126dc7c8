// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "millforce_cnc.h"

/// The functions of millforce_cnc.h as a C compiler makes them (cnc_in_c99.c).

#ifdef __cplusplus
extern "C" {
#endif

void c99_encode_override(const millforce_override* content, uint32_t id, millforce_can_frame* frame);
millforce_result c99_decode_override(const millforce_can_frame* frame, uint32_t id, millforce_override* content);
void c99_encode_status(const millforce_program_status* content, uint32_t counter, uint32_t id,
                       millforce_can_frame* frame);
millforce_result c99_decode_status(const millforce_can_frame* frame, uint32_t id, millforce_program_status* content,
                                   uint32_t* counter);
void c99_receiver_start(millforce_receiver* receiver);
millforce_result c99_on_frame(millforce_receiver* receiver, const millforce_can_frame* frame, uint32_t now_us);
millforce_received c99_now(millforce_receiver* receiver, uint32_t now_us);
void c99_status_start(millforce_status_sender* sender);
bool c99_status_due(millforce_status_sender* sender, const millforce_program_status* status, uint32_t now_us,
                    millforce_can_frame* frame);
void c99_encode_tool(uint32_t number, uint32_t id, millforce_can_frame* frame);
millforce_result c99_decode_tool(const millforce_can_frame* frame, uint32_t id, uint32_t* number);
void c99_tool_start(millforce_tool_sender* sender);
bool c99_tool_due(millforce_tool_sender* sender, uint32_t number, uint32_t now_us, millforce_can_frame* frame);
void c99_encode_speed(uint32_t speed, uint32_t id, millforce_can_frame* frame);
millforce_result c99_decode_speed(const millforce_can_frame* frame, uint32_t id, uint32_t* speed);
void c99_speed_start(millforce_speed_sender* sender);
bool c99_speed_due(millforce_speed_sender* sender, uint32_t speed, uint32_t now_us, millforce_can_frame* frame);
void c99_encode_position(const millforce_position* position, uint32_t counter, uint32_t id, millforce_can_frame* frame);
millforce_result c99_decode_position(const millforce_can_frame* frame, uint32_t id, millforce_position* position,
                                     uint32_t* counter);
void c99_position_start(millforce_position_sender* sender);
bool c99_position_due(millforce_position_sender* sender, const millforce_position* position, uint32_t now_us,
                      millforce_can_frame* frame);

#ifdef __cplusplus
}
#endif
