// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace millforce::host {

/// Locks the memory and requests the real-time scheduler SCHED_FIFO for this thread. If one is not allowed, a note for
/// the user is returned: the program runs without it, and its latency depends on the machine.
std::vector<std::string> become_real_time();

/// Back to the usual scheduler.
void leave_real_time();

/// From now on SIGINT, SIGTERM and SIGHUP set the flag instead of ending the program. Neither a closed pipe nor a file
/// at its size limit ends it: who reads the status may go, the controller stays. SIGUSR1 is for take_reopen_request().
const std::atomic<bool>& stop_on_signal();

/// SIGUSR1 came since the last call: log files were renamed.
bool take_reopen_request();

/// Notifies a service manager (systemd, Type=notify) if there is one, e.g. "READY=1". Never waits for it. No heap.
void notify_service_manager(const char* state);

/// For notify_service_manager() once the override says hold: a slow disk may take its time for what is written at the
/// end, and the service manager waits for it longer than for a loop that stands.
inline constexpr const char* time_for_the_report = "EXTEND_TIMEOUT_USEC=20000000";

/// Tells a service manager that the loop turns, if it wants to know (WATCHDOG_USEC, WATCHDOG_PID): twice in the time
/// after which it ends the program.
class ServiceWatchdog {
  public:
    ServiceWatchdog();
    /// At each turn of the loop, with a monotonic time. No heap, and it never waits.
    void poll(std::uint64_t now_us);

  private:
    std::uint64_t period_us_ = 0;
    std::uint64_t next_us_ = 0;
};

}  // namespace millforce::host
