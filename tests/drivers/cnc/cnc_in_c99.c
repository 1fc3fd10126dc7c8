// SPDX-License-Identifier: Apache-2.0
#include "cnc_in_c99.h"

void c99_encode_override(const millforce_override* content, uint32_t id, millforce_can_frame* frame) {
    millforce_encode_override(content, id, frame);
}

millforce_result c99_decode_override(const millforce_can_frame* frame, uint32_t id, millforce_override* content) {
    return millforce_decode_override(frame, id, content);
}

void c99_encode_status(const millforce_program_status* content, uint32_t counter, uint32_t id,
                       millforce_can_frame* frame) {
    millforce_encode_status(content, counter, id, frame);
}

millforce_result c99_decode_status(const millforce_can_frame* frame, uint32_t id, millforce_program_status* content,
                                   uint32_t* counter) {
    return millforce_decode_status(frame, id, content, counter);
}

void c99_receiver_start(millforce_receiver* receiver) {
    millforce_receiver_start(receiver, millforce_default_settings());
}

millforce_result c99_on_frame(millforce_receiver* receiver, const millforce_can_frame* frame, uint32_t now_us) {
    return millforce_on_frame(receiver, frame, now_us);
}

millforce_received c99_now(millforce_receiver* receiver, uint32_t now_us) {
    return millforce_now(receiver, now_us);
}

void c99_status_start(millforce_status_sender* sender) {
    millforce_status_start(sender);
}

bool c99_status_due(millforce_status_sender* sender, const millforce_program_status* status, uint32_t now_us,
                    millforce_can_frame* frame) {
    return millforce_status_due(sender, status, now_us, frame);
}

void c99_encode_tool(uint32_t number, uint32_t id, millforce_can_frame* frame) {
    millforce_encode_tool(number, id, frame);
}

millforce_result c99_decode_tool(const millforce_can_frame* frame, uint32_t id, uint32_t* number) {
    return millforce_decode_tool(frame, id, number);
}

void c99_encode_speed(uint32_t speed, uint32_t id, millforce_can_frame* frame) {
    millforce_encode_speed(speed, id, frame);
}

millforce_result c99_decode_speed(const millforce_can_frame* frame, uint32_t id, uint32_t* speed) {
    return millforce_decode_speed(frame, id, speed);
}

void c99_speed_start(millforce_speed_sender* sender) {
    millforce_speed_start(sender);
}

bool c99_speed_due(millforce_speed_sender* sender, uint32_t speed, uint32_t now_us, millforce_can_frame* frame) {
    return millforce_speed_due(sender, speed, now_us, frame);
}

void c99_tool_start(millforce_tool_sender* sender) {
    millforce_tool_start(sender);
}

bool c99_tool_due(millforce_tool_sender* sender, uint32_t number, uint32_t now_us, millforce_can_frame* frame) {
    return millforce_tool_due(sender, number, now_us, frame);
}

void c99_encode_position(const millforce_position* position, uint32_t counter, uint32_t id,
                         millforce_can_frame* frame) {
    millforce_encode_position(position, counter, id, frame);
}

millforce_result c99_decode_position(const millforce_can_frame* frame, uint32_t id, millforce_position* position,
                                     uint32_t* counter) {
    return millforce_decode_position(frame, id, position, counter);
}

void c99_position_start(millforce_position_sender* sender) {
    millforce_position_start(sender);
}

bool c99_position_due(millforce_position_sender* sender, const millforce_position* position, uint32_t now_us,
                      millforce_can_frame* frame) {
    return millforce_position_due(sender, position, now_us, frame);
}
