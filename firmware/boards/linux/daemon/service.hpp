// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string>
#include <vector>

namespace millforce::host {

/// Locks the memory and requests the real-time scheduler SCHED_FIFO for this thread. If one is not allowed, a note for
/// the user is returned: the program runs without it, and its latency depends on the machine.
std::vector<std::string> become_real_time();

/// Back to the usual scheduler.
void leave_real_time();

/// From now on SIGINT, SIGTERM and SIGHUP set the flag instead of ending the program, and a closed pipe does not end
/// it.
const std::atomic<bool>& stop_on_signal();

/// Who reads the status may go; the controller stays.
void ignore_closed_pipes();

/// Notifies a service manager (systemd, Type=notify) if there is one, e.g. "READY=1". Never waits for it.
void notify_service_manager(const char* state);

}  // namespace millforce::host
