// SPDX-License-Identifier: Apache-2.0 OR GPL-2.0-or-later
#ifndef MILLFORCE_CNC_H
#define MILLFORCE_CNC_H

#include <stdbool.h>
#include <stdint.h>

/// The CNC's side of the bus between millforce and a CNC: the override frame in, the program status out, and the rule
/// that stops the feed when the controller is silent. For a CNC, a PLC or a small gateway beside it.
///
/// C99 or C++, this header alone: no library, no heap, no floating point, no clock. Bounded loops; a few hundred
/// instructions per frame. One thread per object. Times are in µs, as a count that may wrap. The frames' layouts are in
/// override_frame/override_frame.hpp and, in program_status, program_status_frame.hpp, tool_frame.hpp,
/// speed_frame.hpp and position_frame.hpp; vectors.txt has them as bytes.
///
///     static millforce_receiver receiver;
///     static millforce_status_sender sender;
///     millforce_receiver_start(&receiver, millforce_default_settings());
///     millforce_status_start(&sender);
///     // In each cycle, at least every 5 ms:
///     while (read_from_bus(&frame)) { (void)millforce_on_frame(&receiver, &frame, now_us); }
///     millforce_received received = millforce_now(&receiver, now_us);
///     feed = received.hold ? 0 : programmed_feed * received.ratio / MILLFORCE_RATIO_OF_1;
///     if (millforce_status_due(&sender, &status, now_us, &frame)) { write_to_bus(&frame); }
///     // So that the encoder can be compared with the spindle's speed, with a millforce_speed_sender:
///     if (millforce_speed_due(&speed_sender, speed, now_us, &frame)) { write_to_bus(&frame); }
///     // With tools by number, and a millforce_tool_sender that was started like the other:
///     if (millforce_tool_due(&tool_sender, tool_number, now_us, &frame)) { write_to_bus(&frame); }
///     // Where the controller looks ahead in a part map, and a millforce_position_sender that was started:
///     if (millforce_position_due(&position_sender, &position, now_us, &frame)) { write_to_bus(&frame); }

#define MILLFORCE_OVERRIDE_NODE 126U          ///< CANopen node of the controller; its heartbeat has the id 0x700 + node
#define MILLFORCE_OVERRIDE_ID 0x1FEU          ///< TPDO 1 of node 126
#define MILLFORCE_STATUS_ID 0x1FDU            ///< TPDO 1 of node 125
#define MILLFORCE_RATIO_OF_1 10000U           ///< `ratio` at the programmed feed
#define MILLFORCE_FEED_UNITS_PER_MM_MIN 100U  ///< `feed` at 1 mm/min
#define MILLFORCE_LARGEST_FEED 0xFFFFFFU      ///< 167 772.15 mm/min
#define MILLFORCE_STATUS_PERIOD_US 10000U
#define MILLFORCE_TOOL_ID 0x2FDU  ///< TPDO 2 of node 125
#define MILLFORCE_TOOL_PERIOD_US 100000U
#define MILLFORCE_SPEED_ID 0x4FDU  ///< TPDO 4 of node 125
#define MILLFORCE_SPEED_PERIOD_US 100000U
#define MILLFORCE_SPEED_UNITS_PER_RPM 1000U  ///< `speed` at 1/min
#define MILLFORCE_POSITION_ID 0x3FDU         ///< TPDO 3 of node 125
#define MILLFORCE_POSITION_PERIOD_US 10000U
#define MILLFORCE_DISTANCE_NOT_KNOWN 0xFFFFFFU
#define MILLFORCE_FRAME_BYTES 8U

/// A frame of classical CAN.
typedef struct {
    uint32_t id;
    bool is_extended;  ///< 29-bit id
    bool is_remote;
    uint32_t length;  ///< bytes of data, as received: it is checked
    uint8_t data[8];
} millforce_can_frame;

/// Content of the override frame.
typedef struct {
    uint32_t ratio;    ///< 0.0001 of the programmed feed, 0…65535
    bool hold;         ///< stop the feed whatever the ratio says
    uint32_t state;    ///< state of the controller, for display
    uint32_t fault;    ///< 0: none; for display
    uint32_t counter;  ///< 0…65535, the controller's tick
} millforce_override;

/// Content of the program-status frame.
typedef struct {
    uint32_t feed;               ///< F of the current block, 0.01 mm/min; 0: not known; above the largest: saturates
    uint32_t operator_override;  ///< per cent; above 255: saturates
    bool is_rapid;               ///< G0
    bool is_feed_held;
    bool resets_fault;  ///< a rising edge clears the controller's fault, with all axes at rest
} millforce_program_status;

/// Content of the position frame.
typedef struct {
    uint32_t line;  ///< of the program, of the block in work; 0: not known; above 0xFFFFFF: not known
    uint32_t
        distance;  ///< to go to that block's end along its path, 0.001 mm; from MILLFORCE_DISTANCE_NOT_KNOWN: not known
} millforce_position;

typedef enum {
    millforce_ok,
    millforce_not_this_frame,  ///< another id, a 29-bit id or a remote frame: ignore it
    millforce_wrong_length,
    millforce_wrong_checksum,
    millforce_reserved_bits,     ///< a later layout
    millforce_ratio_too_large,   ///< above `largest_ratio`
    millforce_counter_repeated,  ///< the controller has stopped, or a frame was duplicated
    millforce_counter_jumped,    ///< out of order, or a controller that has restarted: the trust begins again
    millforce_heartbeat_malformed
} millforce_result;

/// Checksum of byte 7: CRC-8 with polynomial 0x2F, initial and final XOR 0xFF, over id low, id high and bytes 0…6.
static inline uint32_t millforce_checksum(uint32_t id, const uint8_t* data) {
    uint32_t crc = 0xFFU;
    for (uint32_t k = 0U; k < 9U; ++k) {
        uint32_t byte = id;
        if (k == 1U) {
            byte = id >> 8U;
        } else if (k >= 2U) {
            byte = data[k - 2U];
        }
        crc ^= byte & 0xFFU;
        for (uint32_t bit = 0U; bit < 8U; ++bit) {
            crc = (crc & 0x80U) != 0U ? ((crc << 1U) ^ 0x2FU) & 0xFFU : (crc << 1U) & 0xFFU;
        }
    }
    return crc ^ 0xFFU;
}

static inline uint32_t millforce_16_bits(const uint8_t* low_byte) {
    const uint32_t low = low_byte[0];
    const uint32_t high = low_byte[1];
    return low | (high << 8U);
}

/// Ends a frame of 8 bytes whose bytes 0…4 are set: counter, checksum, id.
static inline void millforce_finish(millforce_can_frame* frame, uint32_t id, uint32_t counter) {
    frame->id = id & 0x7FFU;
    frame->is_extended = false;
    frame->is_remote = false;
    frame->length = MILLFORCE_FRAME_BYTES;
    frame->data[5] = counter & 0xFFU;
    frame->data[6] = (counter >> 8U) & 0xFFU;
    frame->data[7] = millforce_checksum(frame->id, frame->data) & 0xFFU;
}

static inline millforce_result millforce_check(const millforce_can_frame* frame, uint32_t id) {
    if (frame->id != id || frame->is_extended || frame->is_remote) {
        return millforce_not_this_frame;
    }
    if (frame->length != MILLFORCE_FRAME_BYTES) {
        return millforce_wrong_length;
    }
    return frame->data[7] == millforce_checksum(id, frame->data) ? millforce_ok : millforce_wrong_checksum;
}

/// What the controller sends; for a simulator or a test of the wiring.
static inline void millforce_encode_override(const millforce_override* content, uint32_t id,
                                             millforce_can_frame* frame) {
    frame->data[0] = content->ratio & 0xFFU;
    frame->data[1] = (content->ratio >> 8U) & 0xFFU;
    frame->data[2] = content->hold ? 1U : 0U;
    frame->data[3] = content->state & 0xFFU;
    frame->data[4] = content->fault & 0xFFU;
    millforce_finish(frame, id, content->counter);
}

/// Writes `content` where the result is ok.
static inline millforce_result millforce_decode_override(const millforce_can_frame* frame, uint32_t id,
                                                         millforce_override* content) {
    const millforce_result result = millforce_check(frame, id);
    if (result != millforce_ok) {
        return result;
    }
    if (frame->data[2] > 1U) {
        return millforce_reserved_bits;
    }
    content->ratio = millforce_16_bits(&frame->data[0]);
    content->hold = frame->data[2] == 1U;
    content->state = frame->data[3];
    content->fault = frame->data[4];
    content->counter = millforce_16_bits(&frame->data[5]);
    return millforce_ok;
}

static inline void millforce_encode_status(const millforce_program_status* content, uint32_t counter, uint32_t id,
                                           millforce_can_frame* frame) {
    const uint32_t feed = content->feed < MILLFORCE_LARGEST_FEED ? content->feed : MILLFORCE_LARGEST_FEED;
    const uint32_t percent = content->operator_override < 0xFFU ? content->operator_override : 0xFFU;
    const uint32_t rapid_bit = content->is_rapid ? 1U : 0U;
    const uint32_t hold_bit = content->is_feed_held ? 2U : 0U;
    const uint32_t reset_bit = content->resets_fault ? 4U : 0U;
    frame->data[0] = feed & 0xFFU;
    frame->data[1] = (feed >> 8U) & 0xFFU;
    frame->data[2] = (feed >> 16U) & 0xFFU;
    frame->data[3] = percent & 0xFFU;
    frame->data[4] = (rapid_bit | hold_bit | reset_bit) & 0xFFU;
    millforce_finish(frame, id, counter);
}

/// Writes `content` and `counter` where the result is ok.
static inline millforce_result millforce_decode_status(const millforce_can_frame* frame, uint32_t id,
                                                       millforce_program_status* content, uint32_t* counter) {
    const millforce_result result = millforce_check(frame, id);
    if (result != millforce_ok) {
        return result;
    }
    const uint32_t flags = frame->data[4];
    if (flags > 7U) {
        return millforce_reserved_bits;
    }
    const uint32_t feed_high = frame->data[2];
    content->feed = millforce_16_bits(&frame->data[0]) | (feed_high << 16U);
    content->operator_override = frame->data[3];
    content->is_rapid = (flags & 1U) != 0U;
    content->is_feed_held = (flags & 2U) != 0U;
    content->resets_fault = (flags & 4U) != 0U;
    *counter = millforce_16_bits(&frame->data[5]);
    return millforce_ok;
}

typedef struct {
    uint32_t node;
    uint32_t id;
    uint32_t timeout_us;            ///< longest time without a fresh counter; after it the controller is dead
    uint32_t largest_counter_step;  ///< ticks between two frames, lost frames included
    uint32_t frames_to_trust;       ///< fresh frames in sequence before the override is used (again)
    uint32_t largest_ratio;         ///< a frame with a larger one is refused
    uint32_t fallback_ratio;        ///< while the controller is dead
    bool fallback_hold;             ///< whether the feed stops meanwhile
} millforce_settings;

/// 20 ms of silence stop the feed; overrides up to 2.0.
static inline millforce_settings millforce_default_settings(void) {
    millforce_settings settings;
    settings.node = MILLFORCE_OVERRIDE_NODE;
    settings.id = MILLFORCE_OVERRIDE_ID;
    settings.timeout_us = 20000U;
    settings.largest_counter_step = 50U;
    settings.frames_to_trust = 3U;
    settings.largest_ratio = 2U * MILLFORCE_RATIO_OF_1;
    settings.fallback_ratio = 0U;
    settings.fallback_hold = true;
    return settings;
}

typedef struct {
    millforce_settings settings;
    millforce_override newest;
    bool has_counter;
    bool is_silent;
    uint32_t trusted_frames;
    uint32_t fresh_us;
} millforce_receiver;

/// What the CNC may act on.
typedef struct {
    uint32_t ratio;  ///< 0.0001 of the programmed feed
    bool hold;       ///< stop the feed
    bool is_alive;   ///< false: ratio and hold are the fallback
    uint32_t state;
    uint32_t fault;
} millforce_received;

static inline void millforce_receiver_start(millforce_receiver* receiver, millforce_settings settings) {
    receiver->settings = settings;
    receiver->newest.ratio = 0U;
    receiver->newest.hold = true;
    receiver->newest.state = 0U;
    receiver->newest.fault = 0U;
    receiver->newest.counter = 0U;
    receiver->has_counter = false;
    receiver->is_silent = true;
    receiver->trusted_frames = 0U;
    receiver->fresh_us = 0U;
}

/// Silence lasts until the next fresh frame, so that a time that wraps cannot end it.
static inline void millforce_watch(millforce_receiver* receiver, uint32_t now_us) {
    if (now_us - receiver->fresh_us > receiver->settings.timeout_us) {
        receiver->is_silent = true;
        receiver->trusted_frames = 0U;
    }
}

static inline millforce_result millforce_on_heartbeat(millforce_receiver* receiver, const millforce_can_frame* frame) {
    const uint32_t operational = 5U;
    if (frame->length != 1U) {
        return millforce_heartbeat_malformed;
    }
    if (frame->data[0] != operational) {
        receiver->trusted_frames = 0U;
    }
    return millforce_ok;
}

static inline millforce_result millforce_on_override(millforce_receiver* receiver, const millforce_override* received,
                                                     uint32_t now_us) {
    if (received->ratio > receiver->settings.largest_ratio) {
        return millforce_ratio_too_large;
    }
    const uint32_t step = (received->counter - receiver->newest.counter) & 0xFFFFU;
    const bool is_first = !receiver->has_counter;
    if (!is_first && step == 0U) {
        return millforce_counter_repeated;
    }
    const bool is_jump = !is_first && step > receiver->settings.largest_counter_step;
    if (is_first || is_jump) {
        receiver->trusted_frames = 0U;
    }
    receiver->has_counter = true;
    receiver->is_silent = false;
    receiver->newest = *received;
    receiver->fresh_us = now_us;
    if (receiver->trusted_frames < receiver->settings.frames_to_trust) {
        ++receiver->trusted_frames;
    }
    return is_jump ? millforce_counter_jumped : millforce_ok;
}

/// With each frame of the bus and the time at which it came. Count what is neither ok nor another frame: it shows a
/// wiring fault.
static inline millforce_result millforce_on_frame(millforce_receiver* receiver, const millforce_can_frame* frame,
                                                  uint32_t now_us) {
    millforce_override received;
    millforce_watch(receiver, now_us);
    if (frame->id == 0x700U + receiver->settings.node && !frame->is_extended && !frame->is_remote) {
        return millforce_on_heartbeat(receiver, frame);
    }
    const millforce_result result = millforce_decode_override(frame, receiver->settings.id, &received);
    return result == millforce_ok ? millforce_on_override(receiver, &received, now_us) : result;
}

/// In each cycle: the silence is noticed here. At least once in half an hour, because the time wraps.
static inline millforce_received millforce_now(millforce_receiver* receiver, uint32_t now_us) {
    millforce_received now;
    millforce_watch(receiver, now_us);
    now.is_alive = !receiver->is_silent && receiver->trusted_frames >= receiver->settings.frames_to_trust;
    now.ratio = now.is_alive ? receiver->newest.ratio : receiver->settings.fallback_ratio;
    now.hold = now.is_alive ? receiver->newest.hold : receiver->settings.fallback_hold;
    now.state = now.is_alive ? receiver->newest.state : 0U;
    now.fault = now.is_alive ? receiver->newest.fault : 0U;
    return now;
}

typedef struct {
    uint32_t id;
    millforce_program_status sent;
    bool has_sent;
    uint32_t sent_us;
    uint32_t counter;
} millforce_status_sender;

static inline void millforce_status_start(millforce_status_sender* sender) {
    sender->id = MILLFORCE_STATUS_ID;
    sender->sent.feed = 0U;
    sender->sent.operator_override = 0U;
    sender->sent.is_rapid = false;
    sender->sent.is_feed_held = false;
    sender->sent.resets_fault = false;
    sender->has_sent = false;
    sender->sent_us = 0U;
    sender->counter = 0U;
}

/// In each cycle. True where `frame` is to be sent: every 10 ms, and at once where a flag changes.
static inline bool millforce_status_due(millforce_status_sender* sender, const millforce_program_status* status,
                                        uint32_t now_us, millforce_can_frame* frame) {
    const bool has_changed = status->is_rapid != sender->sent.is_rapid ||
                             status->is_feed_held != sender->sent.is_feed_held ||
                             status->resets_fault != sender->sent.resets_fault;
    const bool is_time = now_us - sender->sent_us >= MILLFORCE_STATUS_PERIOD_US;
    if (sender->has_sent && !has_changed && !is_time) {
        return false;
    }
    sender->counter = (sender->counter + 1U) & 0xFFFFU;
    sender->sent = *status;
    sender->has_sent = true;
    sender->sent_us = now_us;
    millforce_encode_status(status, sender->counter, sender->id, frame);
    return true;
}

/// A number in a frame of its own; 0: none, or not known.
static inline void millforce_encode_number(uint32_t number, uint32_t id, millforce_can_frame* frame) {
    for (uint32_t k = 0U; k < 4U; ++k) {
        frame->data[k] = (number >> (8U * k)) & 0xFFU;
    }
    frame->data[4] = 0U;
    millforce_finish(frame, id, 0U);
}

/// Writes `number` where the result is ok.
static inline millforce_result millforce_decode_number(const millforce_can_frame* frame, uint32_t id,
                                                       uint32_t* number) {
    const millforce_result result = millforce_check(frame, id);
    if (result != millforce_ok) {
        return result;
    }
    if (frame->data[4] != 0U || frame->data[5] != 0U || frame->data[6] != 0U) {
        return millforce_reserved_bits;
    }
    const uint32_t high = millforce_16_bits(&frame->data[2]);
    *number = millforce_16_bits(&frame->data[0]) | (high << 16U);
    return millforce_ok;
}

/// The tool in the spindle.
static inline void millforce_encode_tool(uint32_t number, uint32_t id, millforce_can_frame* frame) {
    millforce_encode_number(number, id, frame);
}

/// Writes `number` where the result is ok.
static inline millforce_result millforce_decode_tool(const millforce_can_frame* frame, uint32_t id, uint32_t* number) {
    return millforce_decode_number(frame, id, number);
}

typedef struct {
    uint32_t id;
    uint32_t sent;
    bool has_sent;
    uint32_t sent_us;
} millforce_tool_sender;

static inline void millforce_tool_start(millforce_tool_sender* sender) {
    sender->id = MILLFORCE_TOOL_ID;
    sender->sent = 0U;
    sender->has_sent = false;
    sender->sent_us = 0U;
}

/// In each cycle. True where `frame` is to be sent: every 100 ms, and at once where the number changes.
static inline bool millforce_tool_due(millforce_tool_sender* sender, uint32_t number, uint32_t now_us,
                                      millforce_can_frame* frame) {
    const bool is_time = now_us - sender->sent_us >= MILLFORCE_TOOL_PERIOD_US;
    if (sender->has_sent && number == sender->sent && !is_time) {
        return false;
    }
    sender->sent = number;
    sender->has_sent = true;
    sender->sent_us = now_us;
    millforce_encode_tool(number, sender->id, frame);
    return true;
}

/// What the spindle's drive is told, the operator's share in it, 0.001/min; 0: not known, or the spindle is off.
static inline void millforce_encode_speed(uint32_t speed, uint32_t id, millforce_can_frame* frame) {
    millforce_encode_number(speed, id, frame);
}

/// Writes `speed` where the result is ok.
static inline millforce_result millforce_decode_speed(const millforce_can_frame* frame, uint32_t id, uint32_t* speed) {
    return millforce_decode_number(frame, id, speed);
}

typedef struct {
    uint32_t id;
    bool has_sent;
    uint32_t sent_us;
} millforce_speed_sender;

static inline void millforce_speed_start(millforce_speed_sender* sender) {
    sender->id = MILLFORCE_SPEED_ID;
    sender->has_sent = false;
    sender->sent_us = 0U;
}

/// In each cycle. True where `frame` is to be sent: every 100 ms.
static inline bool millforce_speed_due(millforce_speed_sender* sender, uint32_t speed, uint32_t now_us,
                                       millforce_can_frame* frame) {
    if (sender->has_sent && now_us - sender->sent_us < MILLFORCE_SPEED_PERIOD_US) {
        return false;
    }
    sender->has_sent = true;
    sender->sent_us = now_us;
    millforce_encode_speed(speed, sender->id, frame);
    return true;
}

/// Line and way to go.
static inline void millforce_encode_position(const millforce_position* position, uint32_t counter, uint32_t id,
                                             millforce_can_frame* frame) {
    const uint32_t line = position->line <= 0xFFFFFFU ? position->line : 0U;
    const uint32_t distance =
        position->distance < MILLFORCE_DISTANCE_NOT_KNOWN ? position->distance : MILLFORCE_DISTANCE_NOT_KNOWN;
    for (uint32_t k = 0U; k < 3U; ++k) {
        frame->data[k] = (line >> (8U * k)) & 0xFFU;
        frame->data[3U + k] = (distance >> (8U * k)) & 0xFFU;
    }
    millforce_finish(frame, id, 0U);
    frame->data[5] = (distance >> 16U) & 0xFFU;
    frame->data[6] = counter & 0xFFU;
    frame->data[7] = millforce_checksum(frame->id, frame->data) & 0xFFU;
}

/// Writes `position` and `counter` where the result is ok.
static inline millforce_result millforce_decode_position(const millforce_can_frame* frame, uint32_t id,
                                                         millforce_position* position, uint32_t* counter) {
    const millforce_result result = millforce_check(frame, id);
    if (result != millforce_ok) {
        return result;
    }
    const uint32_t line_high = frame->data[2];
    const uint32_t distance_high = frame->data[5];
    position->line = millforce_16_bits(&frame->data[0]) | (line_high << 16U);
    position->distance = millforce_16_bits(&frame->data[3]) | (distance_high << 16U);
    *counter = frame->data[6];
    return millforce_ok;
}

typedef struct {
    uint32_t id;
    uint32_t sent_line;
    bool has_sent;
    uint32_t sent_us;
    uint32_t counter;
} millforce_position_sender;

static inline void millforce_position_start(millforce_position_sender* sender) {
    sender->id = MILLFORCE_POSITION_ID;
    sender->sent_line = 0U;
    sender->has_sent = false;
    sender->sent_us = 0U;
    sender->counter = 0U;
}

/// In each cycle. True where `frame` is to be sent: every 10 ms, and at once where the line changes.
static inline bool millforce_position_due(millforce_position_sender* sender, const millforce_position* position,
                                          uint32_t now_us, millforce_can_frame* frame) {
    const bool is_time = now_us - sender->sent_us >= MILLFORCE_POSITION_PERIOD_US;
    if (sender->has_sent && position->line == sender->sent_line && !is_time) {
        return false;
    }
    sender->counter = (sender->counter + 1U) & 0xFFU;
    sender->sent_line = position->line;
    sender->has_sent = true;
    sender->sent_us = now_us;
    millforce_encode_position(position, sender->counter, sender->id, frame);
    return true;
}

#endif
