// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string>
#include <vector>

namespace millforce::host {

/// Locks the memory and asks for the real-time scheduler SCHED_FIFO for this thread. What is not allowed is returned
/// as a note for the user: the program runs without it, and its latencies are the machine's.
std::vector<std::string> become_real_time();

/// Back to the usual scheduler.
void leave_real_time();

/// From now on SIGINT and SIGTERM set the flag instead of ending the program.
const std::atomic<bool>& stop_on_signal();

/// Tells a service manager (systemd, Type=notify) where there is one, e.g. "READY=1".
void notify_service_manager(const char* state);

}  // namespace millforce::host
